"""What a chapter's notebook imports: `from autograder.notebook import check, drive, grade, ros`.

`ros()` switches ROS 2 on for the kernel. `drive(...)` lets a program of the workspace steer the simulated robot,
faster than real time. `check(...)` runs the visible checks. `grade(...)` stands in the locked cells.

Students' programs run in processes of their own, never in the kernel.
"""

from __future__ import annotations

from autograder.notebook.checking import CheckReport, check
from autograder.notebook.driving import DriveReport, drive
from autograder.notebook.errors import Notice
from autograder.ros import activate

__all__ = ["CheckReport", "DriveReport", "Notice", "check", "drive", "grade", "ros"]


def ros() -> None:
    """Switch ROS 2 on for this kernel; after it, `import rclpy` works. Safe to run twice.

    Raises:
        RosError: there is no ROS 2 Jazzy; the message says what mends it.
    """
    activate()


def grade(assignment: str, group: str) -> Notice:
    """Say that the hidden checks of `group` decide after the hand-in; nothing is graded in the kernel."""
    return Notice(
        f"{assignment}: the hidden checks of “{group}” are run after you have handed in, outside this notebook."
    )
