"""Stand-in for `launch_pytest`, which cannot be installed by pip: tests that run beside a launch.

It is imported only where the real package is not; names and semantics are those of `launch_pytest` in ROS 2
Jazzy (https://docs.ros.org/en/jazzy/p/launch_pytest/), the code is the course's own. A fixture made with
`launch_pytest.fixture` returns a launch description; a test marked ``pytest.mark.launch(fixture=...)`` runs
while it is launched. What is not covered raises an error that names it. For the real package run
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
_missing = make_getattr(__name__)


def __getattr__(name: str) -> Any:
    # Pytest loads this package at each start, so what needs `launch` is imported when it is used.
    if name in _SUBMODULES:
        return importlib.import_module(f"{__name__}.{name}")
    return _missing(name)


install_submodule_finder()
