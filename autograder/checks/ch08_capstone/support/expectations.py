"""Expectations about the commands that follow a scan: the robot stands still, drives or turns."""

from __future__ import annotations

from collections.abc import Sequence

from autograder.checking import ReceivedMessage, expect
from autograder.checks.ch02_nodes.support.robot import describe_command
from autograder.checks.ch08_capstone.support.contract import TOLERANCE


def expect_still(commands: Sequence[ReceivedMessage], situation: str, *, fraction: float = 0.0) -> None:
    """Fail the check unless every command is zero."""
    expect(
        bool(commands), f"{situation}, no command was published on cmd_vel: the robot should be told to stand still."
    )
    wrong_command = next((c for c in commands if not _is_still(c)), None)
    action = "" if wrong_command is None else describe_command(wrong_command.message)
    expect(wrong_command is None, f"{situation}, the robot {action}: it should stand still.", fraction=fraction)


def expect_driving(
    commands: Sequence[ReceivedMessage],
    situation: str,
    max_speed: float,
    *,
    fraction: float = 0.0,
    always: bool = False,
) -> None:
    """Fail the check unless the commands drive forward, no faster than `max_speed` m/s.

    A robot that sometimes stands still fails only the checks that set `always`.
    """
    expect(bool(commands), f"{situation}, no command was published on cmd_vel: the robot should drive.")
    wrong_command = next(
        (c for c in _commands_to_test(commands, always) if not 0.0 < c.message.linear.x <= max_speed + TOLERANCE), None
    )
    action = "" if wrong_command is None else describe_command(wrong_command.message)
    expect(
        wrong_command is None,
        f"{situation}, the robot {action}: it should drive forward, at {max_speed:.2f} m/s at most.",
        fraction=fraction,
    )


def expect_turning(
    commands: Sequence[ReceivedMessage], situation: str, side: str, max_speed: float, *, fraction: float = 0.0
) -> None:
    """Fail the check unless the commands turn on the spot to a side, no faster than `max_speed` rad/s.

    As in `expect_driving`, commands to stand still are ignored if other commands turn.
    """
    expect(bool(commands), f"{situation}, no command was published on cmd_vel: the robot should turn.")
    sign = 1.0 if side == "left" else -1.0
    wrong_command = next(
        (
            c
            for c in _commands_to_test(commands)
            if not (_is_near(c.message.linear.x, 0.0) and 0.0 < sign * c.message.angular.z <= max_speed + TOLERANCE)
        ),
        None,
    )
    action = "" if wrong_command is None else describe_command(wrong_command.message)
    expect(
        wrong_command is None,
        f"{situation}, the robot {action}: it should turn {side} on the spot, at {max_speed:.2f} rad/s at most.",
        fraction=fraction,
    )


def _commands_to_test(commands: Sequence[ReceivedMessage], always: bool = False) -> Sequence[ReceivedMessage]:
    """Return the commands that a check tests: all of them if `always`; otherwise those that move, if there are any."""
    return commands if always else [c for c in commands if not _is_still(c)] or commands


def _is_still(command: ReceivedMessage) -> bool:
    return _is_near(command.message.linear.x, 0.0) and _is_near(command.message.angular.z, 0.0)


def _is_near(value: float, expected: float) -> bool:
    return abs(value - expected) <= TOLERANCE  # False for nan
