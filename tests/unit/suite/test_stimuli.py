"""Stimuli and verdicts of the suites: scans made by hand, and commands compared."""

from __future__ import annotations

import math

import pytest
from geometry_msgs.msg import Twist

from autograder.checks.ch02_nodes.support.robot import describe_command, expect_forward, expect_stop, expect_turn
from autograder.checks.ch02_nodes.support.scans import Part, scan
from autograder.harness import ReceivedMessage
from autograder.suite import CheckFailed


def _commands(*pairs: tuple[float, float]) -> list[ReceivedMessage]:
    messages = []
    for linear, angular in pairs:
        command = Twist()
        command.linear.x, command.angular.z = linear, angular
        messages.append(ReceivedMessage(0.0, command))
    return messages


def test_a_scan_of_a_full_turn_has_no_doubled_beam() -> None:
    message = scan()
    assert len(message.ranges) == 360
    assert message.angle_increment == pytest.approx(math.tau / 360)
    assert message.angle_max == pytest.approx(math.tau * 359 / 360)
    assert set(message.ranges) == {3.0}


def test_a_part_covers_its_bearings_whatever_the_first_beam_is() -> None:
    for first, last, beams in ((0.0, None, 360), (-180.0, None, 720), (-90.0, 90.0, 181)):
        message = scan(Part(-10.0, 10.0, 0.5), beams=beams, first_bearing=first, last_bearing=last)
        for index, reading in enumerate(message.ranges):
            bearing = math.degrees(math.remainder(message.angle_min + index * message.angle_increment, math.tau))
            if abs(abs(bearing) - 10.0) > 0.01:
                assert reading == pytest.approx(0.5 if abs(bearing) < 10.0 else 3.0)


def test_a_later_part_of_a_scan_replaces_an_earlier_one() -> None:
    message = scan(Part(-10.0, 10.0, 0.5), Part(0.0, 0.0, math.nan))
    assert math.isnan(message.ranges[0])
    assert message.ranges[5] == pytest.approx(0.5)


def test_the_three_behaviours_are_distinguished() -> None:
    expect_forward(_commands((0.3, 0.0), (0.31, 0.01)), "Now")
    expect_turn(_commands((0.0, 0.5)), "Now")
    expect_stop(_commands((0.0, 0.0)), "Now")


@pytest.mark.parametrize("expected", [expect_forward, expect_turn, expect_stop])
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 1e300])
def test_a_command_that_is_not_finite_is_never_right(expected: object, value: float) -> None:
    assert callable(expected)
    for pair in ((value, value), (value, 0.0), (0.3, value)):
        with pytest.raises(CheckFailed, match=r"Now, the robot .*: it should"):
            expected(_commands(pair), "Now")


def test_one_wrong_command_among_many_fails_the_check() -> None:
    with pytest.raises(CheckFailed, match=r"drove backward at 0.30 m/s: it should drive straight on at 0.3 m/s"):
        expect_forward(_commands((0.3, 0.0), (-0.3, 0.0), (0.3, 0.0)), "Now")


def test_missing_commands_are_never_right() -> None:
    with pytest.raises(CheckFailed, match="Now, no command was published on cmd_vel: the robot should publish zero"):
        expect_stop([], "Now")


@pytest.mark.parametrize(
    ("pair", "description"),
    [
        ((0.0, 0.0), "stood still"),
        ((0.3, 0.0), "drove forward at 0.30 m/s"),
        ((-0.1, 0.5), "drove backward at 0.10 m/s and turned left at 0.50 rad/s"),
        ((0.0, -0.5), "turned right at 0.50 rad/s"),
        ((math.nan, 0.0), "was told to move at nan m/s and 0.0 rad/s"),
    ],
)
def test_a_command_is_described_in_a_sentence(pair: tuple[float, float], description: str) -> None:
    assert describe_command(_commands(pair)[0].message) == description
