"""The student's controller in the harness, shown scans and asked for its commands."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from geometry_msgs.msg import Twist
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String

from autograder.checking import SCAN_SECONDS, AutoHarness, ReceivedMessage, Workspace, expect
from autograder.checks.ch02_nodes.support.contract import EXECUTABLE, FORWARD, PACKAGE, TOLERANCE, TURN

PUBLISHES = {"/scan": LaserScan, "/status": String}
SUBSCRIBES = {"/cmd_vel": Twist}
SETTLED = 0.25  # s: a controller at 10 Hz has answered a scan by then
WRITTEN_SECONDS = 5.0  # of real time until a line that was logged is read; only a silent node takes so long


class Robot(AutoHarness):
    """A harness in which scans are shown and commands are read."""

    def __init__(self, workspace: Workspace, clock_rate: float = 1.0) -> None:
        super().__init__(
            workspace, PACKAGE, EXECUTABLE, publishes=PUBLISHES, subscribes=SUBSCRIBES, clock_rate=clock_rate
        )

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


class Velocity(NamedTuple):
    """A command: `linear` in m/s, `angular` in rad/s."""

    linear: float
    angular: float


STOP, DRIVE, SPIN = Velocity(0.0, 0.0), Velocity(FORWARD, 0.0), Velocity(0.0, TURN)


@dataclass(frozen=True)
class Reactions:
    """The commands by which a robot drives on, and by which it turns: the contract's, or those of one robot.

    Whether the velocities are right is for two checks alone. The others ask which of its reactions a robot shows, so
    that a wrong velocity costs its own sentence and no more.
    """

    forward: Velocity = DRIVE
    turn: Velocity = SPIN

    def expect_forward(self, commands: Sequence[ReceivedMessage], situation: str, *, fraction: float = 0.0) -> None:
        """Fail the check unless every command drives on."""
        _expect(commands, self.forward, situation, "drive straight on at 0.3 m/s", fraction)

    def drives(self, commands: Sequence[ReceivedMessage]) -> bool:
        """Return whether every command drives on."""
        return all(_is(_velocity(received), self.forward) for received in commands)

    def turns(self, commands: Sequence[ReceivedMessage]) -> bool:
        """Return whether every command turns."""
        return all(_is(_velocity(received), self.turn) for received in commands)

    def expect_turn(self, commands: Sequence[ReceivedMessage], situation: str, *, fraction: float = 0.0) -> None:
        """Fail the check unless every command turns."""
        _expect(commands, self.turn, situation, "turn left on the spot at 0.5 rad/s", fraction)


CONTRACT = Reactions()
expect_forward, expect_turn = CONTRACT.expect_forward, CONTRACT.expect_turn


def expect_stop(commands: Sequence[ReceivedMessage], situation: str, *, fraction: float = 0.0) -> None:
    """Fail the check unless every command is zero."""
    _expect(commands, STOP, situation, "publish zero velocity", fraction)


def is_stop(received: ReceivedMessage) -> bool:
    """Return whether a command is zero."""
    return _is(_velocity(received), STOP)


def own_reactions(clear: Sequence[ReceivedMessage], blocked: Sequence[ReceivedMessage]) -> Reactions:
    """Return the reactions of a robot that was shown a clear way, and something just in front of it.

    They are the contract's where the robot has none: it must drive on where the way is clear, always by the same
    command, and do something else where it is not.
    """
    forward, turn = _steady(clear), _steady(blocked)
    moves = forward is not None and not _is(forward, STOP)
    if forward is None or not moves:
        forward = CONTRACT.forward
    if turn is None or _is(turn, forward) or (not moves and _is(turn, STOP)):
        turn = CONTRACT.turn
    return Reactions(forward, turn)


def _steady(commands: Sequence[ReceivedMessage]) -> Velocity | None:
    """Return the one velocity of all commands; None if there are several, or none."""
    told = [_velocity(received) for received in commands]
    finite = bool(told) and all(map(math.isfinite, told[0]))
    return told[0] if finite and all(_is(other, told[0]) for other in told) else None


def describe_command(command: Twist) -> str:
    """Put a command into words."""
    linear, angular = command.linear.x, command.angular.z
    if not (math.isfinite(linear) and math.isfinite(angular)):
        return f"was told to move at {linear} m/s and {angular} rad/s"
    drive = f"drove {'forward' if linear > 0 else 'backward'} at {abs(linear):.2f} m/s" if linear else ""
    turn = f"turned {'left' if angular > 0 else 'right'} at {abs(angular):.2f} rad/s" if angular else ""
    return " and ".join(part for part in (drive, turn) if part) or "stood still"


def _expect(commands: Sequence[ReceivedMessage], right: Velocity, situation: str, wanted: str, fraction: float) -> None:
    expect(bool(commands), f"{situation}, no command came on /cmd_vel: the robot should {wanted}.", fraction=fraction)
    wrong = [received.message for received in commands if not _is(_velocity(received), right)]
    did = describe_command(wrong[0]) if wrong else ""
    expect(not wrong, f"{situation}, the robot {did}: it should {wanted}.", fraction=fraction)


def _velocity(received: ReceivedMessage) -> Velocity:
    return Velocity(received.message.linear.x, received.message.angular.z)


def _is(velocity: tuple[float, float], wanted: tuple[float, float]) -> bool:
    return all(abs(value - right) <= TOLERANCE for value, right in zip(velocity, wanted, strict=True))  # false for nan
