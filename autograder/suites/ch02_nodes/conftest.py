"""The fixtures of the visible checks serve the hidden ones, too."""

from autograder.visible.ch02_nodes.conftest import draw, fresh_robot, robot, stable

__all__ = ["draw", "fresh_robot", "robot", "stable"]
