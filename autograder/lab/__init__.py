"""The laboratory: the trusted side of grading, where a student's node meets the grader as another robot would.

`Workspace` knows a built colcon workspace and how its programs are started in a sandbox. A `Lab` carries one program
and talks with it over DDS: `LockstepLab` steps its time, `RealtimeLab` lets it run and can send it signals. `drive`
puts the program's robot into the simulator, in either of them.
"""

from autograder.lab.drive import Drive, drive
from autograder.lab.either import EitherLab
from autograder.lab.goals import Goal
from autograder.lab.lockstep import LockstepLab
from autograder.lab.meeting import Lab, Program, Stamped
from autograder.lab.realtime import RealtimeLab
from autograder.lab.workspace import Workspace

__all__ = [
    "Drive",
    "EitherLab",
    "Goal",
    "Lab",
    "LockstepLab",
    "Program",
    "RealtimeLab",
    "Stamped",
    "Workspace",
    "drive",
]
