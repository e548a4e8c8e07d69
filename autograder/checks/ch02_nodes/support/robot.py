"""A harness that sends scans to the student's controller, and assertions on its commands."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from geometry_msgs.msg import Twist
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String

from autograder.checking import LOCKSTEP, SCAN_SECONDS, AutoHarness, ReceivedMessage, Workspace, expect
from autograder.checks.ch02_nodes.support.contract import EXECUTABLE, FORWARD, PACKAGE, TOLERANCE, TURN
from autograder.checks.ch02_nodes.support.drawn_scans import DrawnScan, is_near, nearest_ahead

PUBLISHES = {"/scan": LaserScan, "/status": String}
SUBSCRIBES = {"/cmd_vel": Twist}
REPEAT_SECONDS = 0.5  # s for which a check with many scans repeats each of them
SETTLED = 0.25  # s after which a controller at 10 Hz has reacted to a scan
WRITTEN_SECONDS = 5.0  # s of real time to wait for a log line; only a node that logs nothing takes so long


class Robot(AutoHarness):
    """A harness that publishes scans and records commands."""

    def __init__(self, workspace: Workspace, clock_rate: float = 1.0) -> None:
        super().__init__(
            workspace, PACKAGE, EXECUTABLE, publishes=PUBLISHES, subscribes=SUBSCRIBES, clock_rate=clock_rate
        )

    def see(self, scan: LaserScan, seconds: float = 1.0, *, age: float = 0.0) -> list[ReceivedMessage]:
        """Publish a scan ten times a second; return the commands published after the controller's reaction time."""
        start = self.seconds
        for _ in range(round(seconds / SCAN_SECONDS)):
            self.show(scan, age=age)
        return self.messages("/cmd_vel", since=start + SETTLED)

    def show(self, scan: LaserScan, seconds: float = SCAN_SECONDS, *, age: float = 0.0) -> None:
        """Publish a scan whose stamp is `age` seconds old, and run for some seconds."""
        scan.header.stamp.sec, scan.header.stamp.nanosec = divmod(self.next_ns - round(age * 1e9), 10**9)
        self.publish("/scan", scan)
        self.run(seconds)

    def leave_alone(self, seconds: float) -> list[ReceivedMessage]:
        """Publish no scan for a while; return the commands published meanwhile."""
        start = self.seconds
        self.run(seconds)
        return self.messages("/cmd_vel", since=start)


def case_count(robot: Robot) -> int:
    """Return how many drawn cases a check can afford: fewer in real time."""
    return 100 if robot.time == LOCKSTEP else 6


def qos_mismatch(robot: Robot) -> str:
    """Describe why the robot's scan subscription does not match a best-effort lidar, or return an empty string.

    A subscription gets nothing from a publisher that offers less than it requests.
    """
    for peer in robot.node.get_subscriptions_info_by_topic("/scan"):
        if peer.qos_profile.reliability == ReliabilityPolicy.RELIABLE:
            return "it requests reliable delivery, but a lidar offers best effort"
        if peer.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL:
            return "it requests transient local durability, but a lidar offers volatile"
    return ""


class Velocity(NamedTuple):
    """A command: `linear` in m/s, `angular` in rad/s."""

    linear: float
    angular: float


STOP, DRIVE, SPIN = Velocity(0.0, 0.0), Velocity(FORWARD, 0.0), Velocity(0.0, TURN)


@dataclass(frozen=True)
class Reactions:
    """The commands with which a robot drives on and turns: those of the contract, or one robot's own.

    Only two checks test the velocities. The others test which of its reactions a robot shows, so a wrong velocity
    costs only the points of the check that tests it.
    """

    forward: Velocity = DRIVE
    turn: Velocity = SPIN

    def expect_forward(self, commands: Sequence[ReceivedMessage], situation: str, *, fraction: float = 0.0) -> None:
        """Fail the check unless every command drives on."""
        _expect(commands, self.forward, situation, "drive straight on at 0.3 m/s", fraction)

    def drives(self, commands: Sequence[ReceivedMessage]) -> bool:
        """Return whether every command drives on."""
        return all(_matches(_velocity(received), self.forward) for received in commands)

    def turns(self, commands: Sequence[ReceivedMessage]) -> bool:
        """Return whether every command turns."""
        return all(_matches(_velocity(received), self.turn) for received in commands)

    def expect_turn(self, commands: Sequence[ReceivedMessage], situation: str, *, fraction: float = 0.0) -> None:
        """Fail the check unless every command turns."""
        _expect(commands, self.turn, situation, "turn left on the spot at 0.5 rad/s", fraction)

    def expect_for(self, robot: Robot, scan: DrawnScan, *, fraction: float = 0.0) -> None:
        """Fail the check unless the robot reacts to a drawn scan as the contract requires."""
        message = scan.message()
        commands = robot.see(message, REPEAT_SECONDS)
        distances = nearest_ahead(message)
        if len(distances) > 1 and any(all(map(self._is_reaction_to(each), commands)) for each in distances):
            return
        distance = min(distances, key=lambda each: math.inf if each is None else each)
        situation = f"With {scan!r}"
        if distance is None:
            expect_stop(commands, f"{situation}, so that no reading in the forward sector counts", fraction=fraction)
        elif is_near(distance):
            self.expect_turn(commands, situation, fraction=fraction)
        else:
            self.expect_forward(commands, situation, fraction=fraction)

    def _is_reaction_to(self, distance: float | None) -> Callable[[ReceivedMessage], bool]:
        velocity = STOP if distance is None else self.turn if is_near(distance) else self.forward
        return lambda received: _matches(_velocity(received), velocity)


CONTRACT = Reactions()
expect_forward, expect_turn = CONTRACT.expect_forward, CONTRACT.expect_turn


def expect_stop(commands: Sequence[ReceivedMessage], situation: str, *, fraction: float = 0.0) -> None:
    """Fail the check unless every command is zero."""
    _expect(commands, STOP, situation, "publish zero velocity", fraction)


def is_stop(received: ReceivedMessage) -> bool:
    """Return whether a command is zero."""
    return _matches(_velocity(received), STOP)


def observed_reactions(
    clear_commands: Sequence[ReceivedMessage], blocked_commands: Sequence[ReceivedMessage]
) -> Reactions:
    """Return a robot's reactions, given its commands for a clear path and for an obstacle just in front of it.

    The contract's reaction replaces one that the robot lacks. A robot has both if it drives on where the path is clear,
    always with the same command, and publishes another command where the path is blocked.
    """
    forward, turn = _constant_velocity(clear_commands), _constant_velocity(blocked_commands)
    moves = forward is not None and not _matches(forward, STOP)
    if forward is None or not moves:
        forward = CONTRACT.forward
    if turn is None or _matches(turn, forward) or (not moves and _matches(turn, STOP)):
        turn = CONTRACT.turn
    return Reactions(forward, turn)


def _constant_velocity(commands: Sequence[ReceivedMessage]) -> Velocity | None:
    """Return the velocity that all commands have, or None if they differ or if there are no commands."""
    velocities = [_velocity(received) for received in commands]
    is_finite = bool(velocities) and all(map(math.isfinite, velocities[0]))
    return velocities[0] if is_finite and all(_matches(other, velocities[0]) for other in velocities) else None


def describe_command(command: Twist) -> str:
    """Describe a command in words."""
    linear, angular = command.linear.x, command.angular.z
    if not (math.isfinite(linear) and math.isfinite(angular)):
        return f"was told to move at {linear} m/s and {angular} rad/s"
    drive = f"drove {'forward' if linear > 0 else 'backward'} at {abs(linear):.2f} m/s" if linear else ""
    turn = f"turned {'left' if angular > 0 else 'right'} at {abs(angular):.2f} rad/s" if angular else ""
    return " and ".join(part for part in (drive, turn) if part) or "stood still"


def _expect(
    commands: Sequence[ReceivedMessage], expected: Velocity, situation: str, instruction: str, fraction: float
) -> None:
    message = f"{situation}, no command was published on cmd_vel: the robot should {instruction}."
    expect(bool(commands), message, fraction=fraction)
    wrong_commands = [received.message for received in commands if not _matches(_velocity(received), expected)]
    behaviour = describe_command(wrong_commands[0]) if wrong_commands else ""
    expect(not wrong_commands, f"{situation}, the robot {behaviour}: it should {instruction}.", fraction=fraction)


def _velocity(received: ReceivedMessage) -> Velocity:
    return Velocity(received.message.linear.x, received.message.angular.z)


def _matches(velocity: tuple[float, float], expected: tuple[float, float]) -> bool:
    pairs = zip(velocity, expected, strict=True)
    return all(abs(value - target) <= TOLERANCE for value, target in pairs)  # false for nan
