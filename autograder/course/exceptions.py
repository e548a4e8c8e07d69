"""What the course tool raises."""

from autograder.exceptions import AutograderError


class CourseError(AutograderError):
    """A notebook, its metadata or the reference solution is not as the course needs it: says which, where and why."""
