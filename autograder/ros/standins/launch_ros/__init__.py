"""Stand-in for `launch_ros`, which cannot be installed by pip: the part that this course's launch files use.

It is imported only if the real package is not installed. Names, signatures, semantics and errors are those of
`launch_ros` in ROS 2 Jazzy (https://docs.ros.org/en/jazzy/p/launch_ros/); the code was written for the course.
It covers nodes with their parameters, remappings and namespaces, in launch files in Python, XML and YAML.
Lifecycle nodes, composable nodes and timers in ROS time raise an error. For the
real package run `make real-launch`, or source an installation of ROS 2 Jazzy.
"""

from __future__ import annotations

from standin_notice import make_getattr
from standin_submodules import install_submodule_finder

from . import (
    _frontend,
    actions,
    descriptions,
    parameter_descriptions,
    substitutions,
    utilities,
)

__all__ = [
    "_frontend",
    "actions",
    "descriptions",
    "parameter_descriptions",
    "substitutions",
    "utilities",
]

__getattr__ = make_getattr(__name__)

install_submodule_finder()
