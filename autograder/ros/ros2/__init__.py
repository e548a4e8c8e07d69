"""The `ros2` command, where `ros2cli` has no wheel: the same verbs, options, output and exit codes.

This is a stand-in. It steps aside whenever the real `ros2cli` is importable: install that with `make real-launch`, or
source an installation of ROS 2. There is no daemon: each call discovers the graph itself.
"""

from autograder.ros.ros2.main import main, run

__all__ = ["main", "run"]
