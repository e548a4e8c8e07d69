"""The modules that a fork server imports before it forks programs.

A profile only imports modules that its programs would import anyway. A student's program that lacks an import has to
fail in the grader as it does elsewhere.
"""

from __future__ import annotations

import ctypes
import os
import sys
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from importlib import import_module, util
from importlib.metadata import distributions
from pathlib import Path

AUTOGRADER = Path(__file__).resolve().parents[2]
MESSAGES = (
    *("rcl_interfaces", "type_description_interfaces", "action_msgs", "rosgraph_msgs"),
    *("std_msgs", "std_srvs", "geometry_msgs", "sensor_msgs", "nav_msgs"),
)
KINDS = ("generator_py", "typesupport_c", "typesupport_fastrtps_c", "typesupport_introspection_c")


@dataclass(frozen=True)
class Profile:
    """The early imports for one kind of program."""

    load: Callable[[], None]  # imports the modules
    forks_children: bool = False  # whether children of such a program are also forked (`children.py`)
    own_packages: tuple[str, ...] = ()  # its children do not use packages whose names begin with these words


def _import(*names: str, folder: Path | None = None) -> None:
    """Import modules, with `folder` as an additional path."""
    if folder is not None:
        sys.path.append(str(folder))
    for name in names:
        import_module(name)
    if folder is not None:
        sys.path.remove(str(folder))


def _ros() -> None:
    """Load the libraries of ROS and of the common messages, but none of their modules.

    Modules of messages would also import rosidl's generator, which takes an eighth of the time that a program needs to
    start. So the generator is hidden from them.
    """
    sys.modules.setdefault("rosidl_generator_py.generate_py_impl", None)  # type: ignore[arg-type]
    for name in ("rmw_fastrtps_cpp", *(f"{package}__rosidl_{kind}" for package in MESSAGES for kind in KINDS)):
        with suppress(OSError):  # this ROS does not have the library, and does not need it
            ctypes.CDLL(f"lib{name}.so")


def _lockstep() -> None:
    """Import the modules of the host that runs programs in lockstep."""
    _ros()
    _import("lockstep_host.host", folder=AUTOGRADER / "run" / "lockstep")


def _tests() -> None:
    """Import pytest, and the dependencies of numpy and rclpy."""
    _ros()
    _import("numpy", "rclpy", "pytest")
    _import(*(f"_pytest.{name}" for name in sys.modules["_pytest.config"].default_plugins))


def _launch() -> None:
    """Import the launch packages (real or stand-in) and the modules that launched programs commonly use."""
    _tests()
    names = ("launch_ros.actions", "launch_ros.substitutions", "launch.launch_description_sources")
    _import(*names, folder=AUTOGRADER / "ros" / "standins" if util.find_spec("launch") is None else None)


def _colcon() -> None:
    """Import the modules that colcon needs to build Python packages, and those of their setup.py."""
    # colcon looks for CMake when it is imported. These paths are the ones in the sandbox.
    os.environ["PATH"] = os.pathsep.join([str(Path(sys.prefix) / "bin"), "/usr/bin", "/bin"])
    _import("asyncio.subprocess", "setuptools", "distutils.core", "colcon_core.command")
    for point in (point for package in distributions() for point in package.entry_points):
        if point.group.startswith("colcon_") or point.group in ("distutils.commands", "egg_info.writers"):
            with suppress(Exception):  # colcon and setuptools also ignore such errors
                point.load()


PROFILES = {
    "lockstep": Profile(_lockstep),
    "tests": Profile(_tests),
    "launch": Profile(_launch, forks_children=True, own_packages=("launch", "standin")),
    "colcon": Profile(_colcon, forks_children=True, own_packages=("colcon",)),
}
