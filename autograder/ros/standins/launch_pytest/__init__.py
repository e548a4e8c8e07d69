"""Stand-in for `launch_pytest`, which cannot be installed by pip: tests that run during a launch.

It is imported only if the real package is not installed. Names and semantics are those of `launch_pytest` in ROS 2
Jazzy (https://docs.ros.org/en/jazzy/p/launch_pytest/); the code was written for the course. A fixture decorated with
`launch_pytest.fixture` returns a launch description; a test marked ``pytest.mark.launch(fixture=...)`` runs
while it is launched. Any other name raises an error. For the real package run
`make real-launch`, or source an installation of ROS 2 Jazzy.
"""

from __future__ import annotations

import importlib
from typing import Any

from standin_notice import make_getattr
from standin_submodules import install_submodule_finder

from ._fixture import fixture

__all__ = ["actions", "fixture", "tools"]

_SUBMODULES = ("actions", "tools")
_raise_not_covered = make_getattr(__name__)


def __getattr__(name: str) -> Any:
    # Pytest imports this package at each start, so modules that import `launch` are imported on first use.
    if name in _SUBMODULES:
        return importlib.import_module(f"{__name__}.{name}")
    return _raise_not_covered(name)


install_submodule_finder()
