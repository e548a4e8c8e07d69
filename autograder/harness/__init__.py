"""The laboratory: the trusted side of grading, where a student's node meets the grader as another robot would.

A `Harness` starts programs in sandboxes and talks with them over DDS. `SteppedHarness` steps their time.
`RealTimeHarness` lets them run, and can send them signals. `AutoHarness` steps them where that is possible.
`LaunchHarness` runs `ros2 launch`. `drive` puts the programs' robot into the simulator, in any of them.
"""

from autograder.harness.auto import AutoHarness
from autograder.harness.base import Harness, Program, Stamped
from autograder.harness.drive import Drive, drive
from autograder.harness.goals import Goal
from autograder.harness.real_time import RealTimeHarness
from autograder.harness.stepped import SteppedHarness
from autograder.workspace import Workspace

__all__ = [
    "AutoHarness",
    "Drive",
    "Goal",
    "Harness",
    "Program",
    "RealTimeHarness",
    "Stamped",
    "SteppedHarness",
    "Workspace",
    "drive",
]
