"""The error that the course's own tool raises."""

from autograder.exceptions import AutograderError


class CourseError(AutograderError):
    """A notebook, its metadata or the reference solution is wrong. The message names the place and the reason."""
