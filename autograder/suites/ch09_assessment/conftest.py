"""The fixtures of the visible checks serve the hidden ones, too."""

from autograder.visible.ch09_assessment.conftest import draw, start, types

__all__ = ["draw", "start", "types"]
