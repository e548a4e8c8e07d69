"""Errors that occur when ROS 2 is found and used.

RosError
├── RosNotFoundError   neither a sourced ROS 2 nor its wheels can be imported
├── WrongDistroError   the sourced ROS 2 is a different distribution from the course's
└── NoFreeDomainError  all ROS domains of this machine are in use
"""


class RosError(Exception):
    """Base class of all errors about the ROS 2 installation."""


class RosNotFoundError(RosError):
    """Neither a sourced ROS 2 nor its wheels can be imported."""


class WrongDistroError(RosError):
    """The sourced ROS 2 is a different distribution from the course's."""


class NoFreeDomainError(RosError):
    """All ROS domains of this machine are in use."""
