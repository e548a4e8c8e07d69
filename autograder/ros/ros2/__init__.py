"""A stand-in for the `ros2` command, because `ros2cli` has no wheel. It has the same options, output and exit codes.

The real `ros2cli` is used instead if it can be imported: install it with `make real-launch`, or source an installation
of ROS 2. The stand-in has no daemon. Each call discovers the graph itself.
"""

from autograder.ros.ros2.main import main, run

__all__ = ["main", "run"]
