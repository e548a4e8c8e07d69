"""Harnesses for the two programs, and assertions on the dancer's commands and on the alarm's messages after scans."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from geometry_msgs.msg import Twist
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool

from autograder.checking import ReceivedMessage, SteppedHarness, Workspace, expect
from autograder.checks.ch01_package_structure.support import contract

CMD_VEL, SCAN, ALARM = "/cmd_vel", "/scan", "/alarm"
TOLERANCE = 1e-3  # m/s and rad/s: the node is given, and publishes its numbers unchanged


@contextmanager
def dancer(workspace: Workspace, *arguments: str) -> Iterator[SteppedHarness]:
    """Start the dancer in a harness."""
    with SteppedHarness(
        workspace,
        contract.SQUARE_DANCE,
        contract.DANCER,
        subscribes={CMD_VEL: Twist},
        arguments=_ros_arguments(arguments),
    ) as harness:
        yield harness


@contextmanager
def alarm(workspace: Workspace, *arguments: str) -> Iterator[SteppedHarness]:
    """Start the alarm in a harness."""
    with SteppedHarness(
        workspace,
        contract.WALL_ALARM,
        contract.ALARM,
        publishes={SCAN: LaserScan},
        subscribes={ALARM: Bool},
        arguments=_ros_arguments(arguments),
    ) as harness:
        yield harness


def expect_dance(harness: SteppedHarness, side: float) -> None:
    """Fail the check unless the dancer drives one side of this length and then turns to the left."""
    side_seconds = side / contract.SPEED
    harness.run(side_seconds + 2.0)
    commands = harness.messages(CMD_VEL)
    expect(bool(commands), "It published no command on /cmd_vel.")
    side_commands = [command for command in commands if command.seconds < side_seconds - 0.3]
    corner_commands = [command for command in commands if command.seconds > side_seconds + 0.5]
    expect(
        bool(side_commands) and all(_matches(command, contract.SPEED, 0.0) for command in side_commands),
        f"With a side of {side:g} m, it did not drive straight on at {contract.SPEED} m/s for {side_seconds:.1f} s.",
    )
    expect(
        bool(corner_commands) and all(_matches(command, 0.0, contract.TURN) for command in corner_commands),
        f"With a side of {side:g} m, it did not turn to the left after {side_seconds:.1f} s.",
    )


def expect_alarm(harness: SteppedHarness, distance: float, expected: bool) -> None:
    """Fail the check unless the alarm publishes the expected state for an obstacle at this distance."""
    expect(harness.takes(SCAN), "The alarm does not subscribe to scan with the type sensor_msgs/LaserScan.")
    start = harness.seconds
    scan = LaserScan(range_min=0.1, range_max=10.0, angle_increment=0.1)
    scan.ranges = [9.0] * 30 + [distance] + [9.0] * 30
    harness.publish(SCAN, scan)
    harness.run(0.3)
    messages = harness.messages(ALARM, since=start)
    expect(bool(messages), "After a scan, nothing was published on /alarm.")
    state = messages[-1].message.data
    expect(state is expected, f"With something at {distance:.2f} m, the alarm is {state}; it should be {expected}.")


def _matches(command: ReceivedMessage, linear: float, angular: float) -> bool:
    return bool(
        abs(command.message.linear.x - linear) <= TOLERANCE and abs(command.message.angular.z - angular) <= TOLERANCE
    )


def _ros_arguments(arguments: tuple[str, ...]) -> tuple[str, ...]:
    return ("--ros-args", *arguments) if arguments else ()
