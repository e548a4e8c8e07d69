"""The laboratory: the trusted side of grading, where a student's node meets the grader as another robot would.

`Workspace` knows a built colcon workspace and how its programs are started in a sandbox. A `Lab` carries programs
and talks with them over DDS: `LockstepLab` steps their time, `RealtimeLab` lets them run and can send them signals,
`EitherLab` finds out which it has to be. `drive` puts the programs' robot into the simulator, in any of them.
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
