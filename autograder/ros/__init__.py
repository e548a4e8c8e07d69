"""Finds, activates and describes ROS 2.

`find()` returns the ROS 2 that this interpreter can import: a sourced installation, or else the wheels in this virtual
environment. `activate()` activates it for this process. `RosEnvironment.variables()` returns the environment variables
that a child process needs.
"""

from autograder.ros.environment import RosEnvironment, activate, find
from autograder.ros.exceptions import RosError, RosNotFoundError, WrongDistroError

__all__ = ["RosEnvironment", "RosError", "RosNotFoundError", "WrongDistroError", "activate", "find"]
