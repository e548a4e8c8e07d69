"""Stand-in for `launch_testing`, which cannot be installed by pip: tests of what a launch description starts.

It is imported only where the real package is not; names and semantics are those of `launch_testing` in ROS 2 Jazzy
(https://docs.ros.org/en/jazzy/p/launch_testing/), the code is the course's own. A file has a function
``generate_test_description`` that returns a launch description with a `ReadyToTest` in it, and test cases of
`unittest`. They run beside the launch, or with `post_shutdown_test` after its end. Pytest runs the file if the
function is marked ``pytest.mark.launch_test``. What is not covered, such as the command ``launch_test``, raises an
error that names it. For the real package run `make real-launch`, or source an installation of ROS 2 Jazzy.
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

_HOMES = {
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
_missing = make_getattr(__name__)


def __getattr__(name: str) -> Any:
    # Pytest loads this package at each start, so what needs `launch` is imported when it is used.
    if name in _SUBMODULES:
        return importlib.import_module(f"{__name__}.{name}")
    if name in _HOMES:
        return getattr(importlib.import_module(f"{__name__}.{_HOMES[name]}"), name)
    return _missing(name)


install_submodule_finder()
