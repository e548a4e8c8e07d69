"""What a chapter's notebook imports: `from autograder.notebook import check, drive, grade, ros`.

`ros()` switches ROS 2 on for the kernel. `drive(...)` lets a program of the workspace steer the simulated robot,
faster than real time; `side_by_side(...)` compares drives. `check(...)` runs the visible checks. `grade(...)` stands in
the locked cells. `source(...)` does for the kernel what `source install/setup.bash`
does in a terminal; `simulator(...)` lets the robot live in the kernel for a while.

Students' programs run in processes of their own, never in the kernel.
"""

from __future__ import annotations

import os

from autograder.notebook.checking import CheckReport, check
from autograder.notebook.comparing import side_by_side
from autograder.notebook.driving import DriveReport, drive
from autograder.notebook.exceptions import Notice
from autograder.notebook.simulator_session import SimulatorSession, simulator
from autograder.notebook.sourcing import source
from autograder.ros import activate
from autograder.ros.domains import Domain

__all__ = [
    "CheckReport",
    "DriveReport",
    "Notice",
    "SimulatorSession",
    "check",
    "drive",
    "grade",
    "ros",
    "side_by_side",
    "simulator",
    "source",
]


def ros() -> None:
    """Switch ROS 2 on for this kernel; after it, `import rclpy` works. Safe to run twice.

    The kernel gets a ROS domain of its own, unless `ROS_DOMAIN_ID` names one: two notebooks, or two students on one
    network, do not hear each other.

    Raises:
        RosError: there is no ROS 2 Jazzy; the message says what mends it.
    """
    given = os.environ.get("ROS_DOMAIN_ID")
    activate(domain=Domain().number if given is None else int(given))


def grade(assignment: str, group: str) -> Notice:
    """Say that the hidden checks of `group` decide after the hand-in; nothing is graded in the kernel."""
    return Notice(
        f"{assignment}: the hidden checks of “{group}” are run after you have handed in, outside this notebook."
    )
