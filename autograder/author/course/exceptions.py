"""The error for mistakes in a course."""

from autograder.exceptions import AutograderError


class CourseError(AutograderError):
    """A notebook, its metadata or the reference solution is invalid. The message names the place and the reason."""
