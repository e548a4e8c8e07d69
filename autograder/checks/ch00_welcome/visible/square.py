"""Checks of the student's square: first the function alone, then the robot."""

from __future__ import annotations

import math

from geometry_msgs.msg import Twist

from autograder.checking import SteppedHarness, Workspace, expect, group, hint
from autograder.checking.probes import calls

check = group("square")
MODULE = "first_robot.square"
SIDE, TURN = 4.0, 2.0  # s for a side, and for the turn at a corner
SPEED, RATE = 0.3, math.radians(90.0) / TURN  # m/s along a side; rad/s at a corner
TOLERANCE = 0.01  # m/s and rad/s: a speed may be rounded to two decimal places
DOC = "https://docs.python.org/3/library/stdtypes.html#numeric-types-int-float-complex"


@check(points=1, covers="side")
@hint("Return two numbers: return SPEED, 0.0", "The first SIDE_SECONDS of a round are a side.")
def test_side(workspace: Workspace) -> None:
    """At the start of a round the robot drives straight on at 0.3 m/s."""
    _expect(workspace, 0.0, SPEED, 0.0)
    _expect(workspace, SIDE - 0.1, SPEED, 0.0)


@check(points=1, covers="corner", needs=("side",))
@hint("After SIDE_SECONDS it turns: return 0.0, TURN_RATE", "A positive rate turns to the left.")
def test_corner(workspace: Workspace) -> None:
    """After 4 s it turns left on the spot, 90 degrees in 2 s."""
    _expect(workspace, SIDE, 0.0, RATE)
    _expect(workspace, SIDE + TURN - 0.1, 0.0, RATE)


@check(points=1, covers="rounds", needs=("corner",), doc=DOC)
@hint("seconds % (SIDE_SECONDS + TURN_SECONDS) is how far the present round is.", "7.5 % 6.0 is 1.5.")
def test_goes_on(workspace: Workspace) -> None:
    """After 6 s the next side begins, and so on for ever."""
    _expect(workspace, 7.0 * (SIDE + TURN) + 1.0, SPEED, 0.0)
    _expect(workspace, 7.0 * (SIDE + TURN) + SIDE + 1.0, 0.0, RATE)


@check(points=1, covers=("side", "corner"), needs=("goes_on",))
@hint("The node calls command_at; leave the class as it is.", "Save the file by running its cell.")
def test_robot(workspace: Workspace) -> None:
    """The robot itself does so, ten commands a second."""
    with SteppedHarness(workspace, "first_robot", "square", subscribes={"/cmd_vel": Twist}) as harness:
        harness.run(SIDE + TURN)
        commands = [received.message for received in harness.messages("/cmd_vel")]
    expect(58 <= len(commands) <= 62, f"In 6 s it published {len(commands)} commands.")
    forward_seconds = sum(_near(command.linear.x, SPEED) for command in commands) / 10.0
    turning_seconds = sum(_near(command.angular.z, RATE) for command in commands) / 10.0
    is_square = abs(forward_seconds - SIDE) <= 0.2 and abs(turning_seconds - TURN) <= 0.2
    expect(
        is_square,
        f"In 6 s it drove for {forward_seconds:.1f} s and turned for {turning_seconds:.1f} s, instead of 4 s and 2 s.",
    )


def _expect(workspace: Workspace, seconds: float, linear: float, angular: float) -> None:
    call_text = f"command_at({seconds:g})"
    (outcome,) = calls.run_steps(workspace, MODULE, calls.call("command_at", seconds))
    result = calls.value(outcome, call_text)
    is_pair = isinstance(result, list) and len(result) == 2 and all(isinstance(x, int | float) for x in result)
    expect(is_pair, f"{call_text} returned {result} instead of two numbers.")
    is_correct = _near(result[0], linear) and _near(result[1], angular)
    expected = f"({linear:.3f}, {angular:.3f})"
    expect(is_correct, f"{call_text} returned ({result[0]:.3f}, {result[1]:.3f}) instead of {expected}.")


def _near(value: float, expected: float) -> bool:
    return abs(value - expected) <= TOLERANCE
