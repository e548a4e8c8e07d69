"""The command `launch_test FILE` of the real `launch_testing`. The stand-in lacks it, and its error says so."""

from __future__ import annotations

import importlib
import sys

from autograder.ros.environment import activate
from autograder.ros.exceptions import RosError


def main() -> None:
    """Switch ROS 2 on and run the file that the command line names; exit as `launch_testing` does."""
    try:
        activate()
    except RosError as error:
        sys.exit(str(error))
    try:
        command = importlib.import_module("launch_testing.launch_test")
    except ImportError as error:
        sys.exit(str(error))
    command.main()
