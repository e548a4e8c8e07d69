"""The one place that knows how ROS 2 is found, switched on and described.

`find()` says which ROS 2 this interpreter can use: a sourced installation wins, then the wheels of this
virtual environment. `activate()` switches it on for this process; `RosEnvironment.variables()` are the
environment variables that a child process needs.
"""

from autograder.ros.environment import RosEnvironment, activate, find
from autograder.ros.exceptions import RosError, RosNotFoundError, WrongDistroError

__all__ = ["RosEnvironment", "RosError", "RosNotFoundError", "WrongDistroError", "activate", "find"]
