"""The student's node in the harness, which sends it scans and records what it publishes."""

from collections.abc import Sequence

from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32

from autograder.checking import AutoHarness, Workspace, expect
from autograder.checks.chNEW_CHAPTER.support import contract

SECONDS = 0.1  # ROS time between two scans, in s


class Robot(AutoHarness):
    """The node, with a publisher of `scan` and a subscription to `nearest`."""

    def __init__(self, workspace: Workspace, *arguments: str) -> None:
        """Create the harness of the node with command-line arguments, such as `--ros-args -p name:=value`."""
        super().__init__(
            workspace,
            contract.PACKAGE,
            contract.EXECUTABLE,
            publishes={"/scan": LaserScan},
            subscribes={"/nearest": Float32},
            arguments=arguments,
        )

    def answers(self, readings: Sequence[float]) -> list[float]:
        """Publish one scan, and return the readings that the node publishes in response."""
        scan = LaserScan(range_min=contract.RANGE_MIN, range_max=contract.RANGE_MAX, ranges=readings)
        sent_at = self.seconds
        self.publish("/scan", scan)
        self.run(SECONDS)
        return [received.message.data for received in self.messages("/nearest", since=sent_at)]


def expect_nearest(robot: Robot, readings: Sequence[float], nearest: float) -> None:
    """Fail the check unless the node publishes exactly this reading for a scan."""
    answers = robot.answers(readings)
    is_correct = len(answers) == 1 and abs(answers[0] - nearest) < contract.TOLERANCE
    expect(
        is_correct,
        f"The nearest reading that counts was {nearest:.3f} m, but the node published {answers or 'nothing'}.",
    )
