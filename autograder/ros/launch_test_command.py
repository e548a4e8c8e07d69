"""The command `launch_test FILE`, which runs the real `launch_testing`. With the stand-in, it only prints an error."""

from __future__ import annotations

import importlib
import sys

from autograder.ros.environment import activate
from autograder.ros.exceptions import RosError


def main() -> None:
    """Activate ROS 2 and run the file that the command line names. The exit code is that of `launch_testing`."""
    try:
        activate()
    except RosError as error:
        sys.exit(str(error))
    try:
        command = importlib.import_module("launch_testing.launch_test")
    except ImportError as error:
        sys.exit(str(error))
    command.main()
