"""Stand-in for `launch_testing`, which cannot be installed by pip: tests of the processes of a launch description.

It is imported only if the real package is not installed. Names and semantics are those of `launch_testing` in ROS 2
Jazzy (https://docs.ros.org/en/jazzy/p/launch_testing/); the code was written for the course. A file has a function
``generate_test_description`` that returns a launch description with a `ReadyToTest`, and test cases of `unittest`.
They run during the launch, or with `post_shutdown_test` after its end. Pytest runs the file if the function is marked
``pytest.mark.launch_test``. Any other name raises an error, as does the command ``launch_test``. For the real package
run `make real-launch`, or source an installation of ROS 2 Jazzy.
"""

from __future__ import annotations

import importlib
from typing import Any

from standin_notice import make_getattr
from standin_submodules import install_submodule_finder

__all__ = [
    "ActiveIoHandler",
    "ActiveProcInfoHandler",
    "IoHandler",
    "ProcInfoHandler",
    "ReadyAggregator",
    "parametrize",
    "post_shutdown_test",
    "ready_to_test_action_timeout",
]

_MODULES = {
    "ActiveIoHandler": "io_handler",
    "ActiveProcInfoHandler": "proc_info_handler",
    "IoHandler": "io_handler",
    "ProcInfoHandler": "proc_info_handler",
    "ReadyAggregator": "ready_aggregator",
    "parametrize": "markers",
    "post_shutdown_test": "markers",
    "ready_to_test_action_timeout": "markers",
}
_SUBMODULES = ("actions", "asserts", "event_handlers", "markers", "tools", "util")
_raise_not_covered = make_getattr(__name__)


def __getattr__(name: str) -> Any:
    # Pytest imports this package at each start, so modules that import `launch` are imported on first use.
    if name in _SUBMODULES:
        return importlib.import_module(f"{__name__}.{name}")
    if name in _MODULES:
        return getattr(importlib.import_module(f"{__name__}.{_MODULES[name]}"), name)
    return _raise_not_covered(name)


install_submodule_finder()
