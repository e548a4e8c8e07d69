"""Names that a new package or node must not have, because Python, pip, ROS or colcon uses them.

Python finds a student's package before installed ones. A package called `launch` would hide ROS's own, and programs
that import it would fail for a reason that a student cannot see.
"""

from __future__ import annotations

import importlib.util
import json
import keyword
import re
import sys
from functools import cache
from importlib import metadata
from pathlib import Path

NAME = re.compile(r"[a-z](?:_?[a-z0-9]+)*")
# Released ROS packages. Most are not installed here, but students will meet them elsewhere.
ROS_PACKAGES = Path(__file__).with_name("ros_packages.json")
# PyPI packages that are not installed with the course, but that robot programs often import.
OFTEN_INSTALLED = {
    *("cv2", "flask", "gym", "gymnasium", "jax", "keras", "networkx", "numba", "open3d", "opencv", "pandas", "pillow"),
    *("pygame", "pyserial", "requests", "scipy", "serial", "shapely", "sklearn", "sympy", "tensorflow", "torch"),
    *("torchvision", "transforms3d", "ultralytics"),
}
USED_BY_TOOLS = {"build", "install", "log", "src", "ws", "setup", "conftest", "tests", "docs"}


def is_package_name(name: str) -> bool:
    """Return whether a name is valid for a ROS package and a Python module."""
    return NAME.fullmatch(name) is not None and not keyword.iskeyword(name)


def owner_of(name: str) -> str:
    """Return the owner of a name, such as "a package of ROS", or "" if the name is free."""
    if name in sys.stdlib_module_names:
        return "a module of Python's standard library"
    if name in _ros_packages():
        return "a package of ROS"
    if name in USED_BY_TOOLS:
        return "a name that colcon, setuptools or pytest uses"
    if name.replace("_", "-") in _pip_packages():
        return "a package that pip installed"
    if _is_importable(name):
        return "a module that Python can already import"
    return "a package of PyPI that robots often use" if name in OFTEN_INSTALLED else ""


@cache
def _ros_packages() -> frozenset[str]:
    return frozenset(json.loads(ROS_PACKAGES.read_text(encoding="utf-8"))["names"])


@cache
def _pip_packages() -> frozenset[str]:
    """Return the normalized names of the packages that pip installed."""
    names = (str(distribution.metadata["Name"]) for distribution in metadata.distributions())
    return frozenset(re.sub(r"[-_.]+", "-", name).lower() for name in names)


def _is_importable(name: str) -> bool:
    """Return whether a module has this name. A folder on Python's path without Python files does not count."""
    spec = importlib.util.find_spec(name)
    return spec is not None and spec.origin is not None
