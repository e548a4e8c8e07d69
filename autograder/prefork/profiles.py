"""What a fork server imports before it forks programs: one table.

A profile imports nothing that its programs would not import anyway. A student's program that lacks an import has to
fail in the grader as it does elsewhere.
"""

from __future__ import annotations

import ctypes
import sys
from collections.abc import Callable
from contextlib import suppress
from importlib import import_module
from pathlib import Path

AUTOGRADER = Path(__file__).resolve().parents[1]
MESSAGES = (
    *("rcl_interfaces", "type_description_interfaces", "action_msgs", "rosgraph_msgs"),
    *("std_msgs", "std_srvs", "geometry_msgs", "sensor_msgs", "nav_msgs"),
)
KINDS = ("generator_py", "typesupport_c", "typesupport_fastrtps_c", "typesupport_introspection_c")


def _import(*names: str, folder: Path | None = None) -> None:
    """Import modules; those that no path leads to are in `folder`."""
    if folder is not None:
        sys.path.append(str(folder))
    for name in names:
        import_module(name)
    if folder is not None:
        sys.path.remove(str(folder))


def _ros() -> None:
    """Load the libraries of ROS and of the common messages, and no module of them.

    A module of messages imports rosidl's generator if it can, which takes an eighth of a program's start: it cannot.
    """
    sys.modules.setdefault("rosidl_generator_py.generate_py_impl", None)  # type: ignore[arg-type]
    for name in ("rmw_fastrtps_cpp", *(f"{package}__rosidl_{kind}" for package in MESSAGES for kind in KINDS)):
        with suppress(OSError):  # a ROS that does without one of them is as good
            ctypes.CDLL(f"lib{name}.so")


def _lockstep() -> None:
    """Import what the host of programs in lockstep imports."""
    _ros()
    _import("lockstep_host.host", "lockstep_host.pipes", folder=AUTOGRADER / "lockstep")


def _tests() -> None:
    """Import pytest, and what `import numpy` and `import rclpy` bring."""
    _ros()
    _import("numpy", "rclpy", "pytest")
    _import(*(f"_pytest.{name}" for name in sys.modules["_pytest.config"].default_plugins))


PROFILES: dict[str, Callable[[], None]] = {"lockstep": _lockstep, "tests": _tests}
