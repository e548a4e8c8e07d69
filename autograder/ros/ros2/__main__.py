"""`python -m autograder.ros.ros2`."""

from autograder.ros.ros2.main import run

run()
