"""Test harnesses: the trusted process runs a student's nodes in sandboxes and talks with them over DDS.

`SteppedHarness` advances the programs' time in steps. `RealTimeHarness` runs them in real time, and can send them
signals. `AutoHarness` steps programs where that is possible. `launch.LaunchHarness` runs `ros2 launch`. `drive` lets
the programs steer the simulated robot, in any harness except `LaunchHarness`. `Shared` keeps a harness for several
checks.
"""

from autograder.harness.auto import AutoHarness
from autograder.harness.base import Harness, Program
from autograder.harness.drive import drive
from autograder.harness.goals import Goal, ReceivedMessage
from autograder.harness.real_time import RealTimeHarness
from autograder.harness.shared import Shared
from autograder.harness.stepped import SteppedHarness
from autograder.run.workspace import Workspace

__all__ = [
    "AutoHarness",
    "Goal",
    "Harness",
    "Program",
    "RealTimeHarness",
    "ReceivedMessage",
    "Shared",
    "SteppedHarness",
    "Workspace",
    "drive",
]
