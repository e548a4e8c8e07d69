"""Errors of finding and using ROS 2.

RosError
├── RosNotFoundError   neither a sourced ROS 2 nor the wheels are there
├── WrongDistroError   a ROS 2 is sourced, but it is of another distribution
└── NoDomainLeftError  each ROS domain of this machine is in use
"""


class RosError(Exception):
    """Base of every error about the ROS 2 installation."""


class RosNotFoundError(RosError):
    """Neither a sourced ROS 2 nor its wheels can be imported."""


class WrongDistroError(RosError):
    """The sourced ROS 2 is of another distribution than the course's."""


class NoDomainLeftError(RosError):
    """Each ROS domain of this machine is in use."""
