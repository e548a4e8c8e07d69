"""The student's controller in the harness, shown scans and asked for its commands."""

from __future__ import annotations

import math
from collections.abc import Sequence

from geometry_msgs.msg import Twist
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String

from autograder.checks import expect
from autograder.checks.ch02_nodes.support.contract import EXECUTABLE, FORWARD, PACKAGE, TOLERANCE, TURN
from autograder.harness import AutoHarness, ReceivedMessage, Workspace
from autograder.harness.drive import SCAN_SECONDS

OFFERS = {"/scan": LaserScan, "/status": String}
LISTENS = {"/cmd_vel": Twist}
SETTLED = 0.25  # s: a controller at 10 Hz has answered a scan by then
WRITTEN_SECONDS = 5.0  # of real time until a line that was logged is read; only a silent node takes so long


class Robot(AutoHarness):
    """A harness in which scans are shown and commands are read."""

    def __init__(self, workspace: Workspace, clock_rate: float = 1.0) -> None:
        super().__init__(workspace, PACKAGE, EXECUTABLE, offers=OFFERS, listens=LISTENS, clock_rate=clock_rate)

    def see(self, scan: LaserScan, seconds: float = 1.0, *, late: float = 0.0) -> list[ReceivedMessage]:
        """Show a scan ten times a second; return the commands that came once the controller had time to react."""
        began = self.seconds
        for _ in range(round(seconds / SCAN_SECONDS)):
            self.show(scan, late=late)
        return self.messages("/cmd_vel", since=began + SETTLED)

    def show(self, scan: LaserScan, seconds: float = SCAN_SECONDS, *, late: float = 0.0) -> None:
        """Show one scan, taken now or `late` seconds ago, and let this time pass."""
        scan.header.stamp.sec, scan.header.stamp.nanosec = divmod(self.next_ns - round(late * 1e9), 10**9)
        self.publish("/scan", scan)
        self.run(seconds)

    def left_alone(self, seconds: float) -> list[ReceivedMessage]:
        """Show nothing for a while; return the commands of that time."""
        began = self.seconds
        self.run(seconds)
        return self.messages("/cmd_vel", since=began)


def qos_mismatch(robot: Robot) -> str:
    """Say why a best-effort lidar would not reach the robot's scan subscription; an empty string if it does.

    A subscription gets nothing from a publisher that offers less than it requests.
    """
    for peer in robot.node.get_subscriptions_info_by_topic("/scan"):
        if peer.qos_profile.reliability == ReliabilityPolicy.RELIABLE:
            return "it requests reliable delivery, a lidar offers best effort"
        if peer.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL:
            return "it requests past messages (transient local), a lidar offers volatile ones"
    return ""


def expect_forward(commands: Sequence[ReceivedMessage], situation: str, *, fraction: float = 0.0) -> None:
    """Fail the check unless every command drives straight on."""
    _expect(commands, FORWARD, 0.0, situation, "drive straight on at 0.3 m/s", fraction)


def expect_turn(commands: Sequence[ReceivedMessage], situation: str, *, fraction: float = 0.0) -> None:
    """Fail the check unless every command turns left on the spot."""
    _expect(commands, 0.0, TURN, situation, "turn left on the spot at 0.5 rad/s", fraction)


def expect_stop(commands: Sequence[ReceivedMessage], situation: str, *, fraction: float = 0.0) -> None:
    """Fail the check unless every command is zero."""
    _expect(commands, 0.0, 0.0, situation, "publish zero velocity", fraction)


def describe_command(command: Twist) -> str:
    """Put a command into words."""
    linear, angular = command.linear.x, command.angular.z
    if not (math.isfinite(linear) and math.isfinite(angular)):
        return f"was told to move at {linear} m/s and {angular} rad/s"
    drive = f"drove {'forward' if linear > 0 else 'backward'} at {abs(linear):.2f} m/s" if linear else ""
    turn = f"turned {'left' if angular > 0 else 'right'} at {abs(angular):.2f} rad/s" if angular else ""
    return " and ".join(part for part in (drive, turn) if part) or "stood still"


def _expect(
    commands: Sequence[ReceivedMessage],
    linear: float,
    angular: float,
    situation: str,
    wanted: str,
    fraction: float = 0.0,
) -> None:
    expect(bool(commands), f"{situation}, no command came on /cmd_vel: the robot should {wanted}.", fraction=fraction)
    wrong = [
        received.message
        for received in commands
        if not (_near(received.message.linear.x, linear) and _near(received.message.angular.z, angular))
    ]
    did = describe_command(wrong[0]) if wrong else ""
    expect(not wrong, f"{situation}, the robot {did}: it should {wanted}.", fraction=fraction)


def _near(value: float, wanted: float) -> bool:
    return abs(value - wanted) <= TOLERANCE  # false for nan
