"""The student's node in the harness: it is shown scans and asked what it published."""

from collections.abc import Sequence

from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32

from autograder.checking import AutoHarness, Workspace, expect
from autograder.checks.chNEW_CHAPTER.support import contract

SECONDS = 0.1  # of ROS time, from one scan to the next


class Robot(AutoHarness):
    """The node between a lidar and whoever listens to `nearest`."""

    def __init__(self, workspace: Workspace, *arguments: str) -> None:
        """Describe the node as it runs with command-line arguments, such as `--ros-args -p name:=value`."""
        super().__init__(
            workspace,
            contract.PACKAGE,
            contract.EXECUTABLE,
            publishes={"/scan": LaserScan},
            subscribes={"/nearest": Float32},
            arguments=arguments,
        )

    def answers(self, readings: Sequence[float]) -> list[float]:
        """Show one scan, and return what the node published then."""
        scan = LaserScan(range_min=contract.RANGE_MIN, range_max=contract.RANGE_MAX, ranges=readings)
        began = self.seconds
        self.publish("/scan", scan)
        self.run(SECONDS)
        return [received.message.data for received in self.messages("/nearest", since=began)]


def expect_nearest(robot: Robot, readings: Sequence[float], nearest: float) -> None:
    """Fail the check unless the node answers a scan with this one reading."""
    answers = robot.answers(readings)
    right = len(answers) == 1 and abs(answers[0] - nearest) < contract.TOLERANCE
    expect(
        right, f"The nearest reading that counts was {nearest:.3f} m, and the node published {answers or 'nothing'}."
    )
