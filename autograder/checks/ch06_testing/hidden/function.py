"""Checks that tests of the pure function fail if safe_speed breaks its contract."""

from __future__ import annotations

from autograder.checking import check_each_row, group, hint
from autograder.checks.ch06_testing.hidden.examination import BACKWARDS, Examination, Line
from autograder.checks.ch06_testing.support import contract
from autograder.checks.ch06_testing.support.assertions import expect_passed
from autograder.checks.ch06_testing.support.contract import LIMITS

check = group("function")
RIGHT_CHECK = ("limits_right",)


@check(points=2, covers="limits-pass", doc=contract.PYTEST)
@hint("Run them: colcon test, or python -m pytest test/test_limits.py in the package's folder.", contract.ALL_PASS)
def test_limits_pass(examination: Examination) -> None:
    """At least six tests in test_limits.py run, and all pass on the package as it is."""
    expect_passed(LIMITS, examination.trial.get(LIMITS))


@check(points=1, covers=("limits-pass", "approx"), after=("limits_pass",), doc=contract.APPROX)
@hint("Other people may write safe_speed in other words: only the contract in its docstring is sure.")
@hint("Floats that are worked out in another order differ in the last digit: pytest.approx.")
def test_limits_right(examination: Examination) -> None:
    """They pass on every right safe_speed, in any order."""
    examination.expect_right(LIMITS, BACKWARDS)


LINES = (
    Line(
        id="stop",
        covers=("stop", "function-lines"),
        title="A test fails when the robot does not stand still in front of near things.",
        promise="at stop_distance and nearer, the speed is 0.0, not a little more or less.",
        points=1,
        hints=(
            "What does it return for a wall at 0.3 m, exactly?",
            contract.MUTATE,
        ),
    ),
    Line(
        id="slow",
        covers=("slow", "function-lines"),
        title="A test fails when the speed between the two distances is not on a straight line.",
        promise="between the two distances the speed grows in a straight line.",
        points=2,
        hints=(
            "One point between the two distances shows that it slows down; two show that the line is straight.",
            "Half-way, and at a quarter: assert safe_speed(0.8, 0.75) == pytest.approx(0.2).",
        ),
        doc=contract.APPROX,
    ),
    Line(
        id="clear",
        covers=("clear", "function-lines"),
        title="A test fails when far things change the speed.",
        promise="at slow_distance and farther, the speed is the wanted one.",
        points=1,
        hints=(
            "What does it return for a wall at 4 m, exactly, and at slow_distance itself? Not only: more than 0.",
            contract.MUTATE,
        ),
        doc=contract.APPROX,
    ),
    Line(
        id="infinity",
        covers=("infinity", "function-lines"),
        title='A test fails when "nothing ahead" is not a clear way.',
        promise="a distance of inf is a clear way.",
        points=1,
        hints=(
            "A sensor that sees nothing says inf.",
            "assert safe_speed(0.8, math.inf) == ...",
        ),
        doc=contract.REP_117,
    ),
    Line(
        id="unknown",
        covers=("unknown", "function-lines"),
        title="A test fails when an unknown distance lets the robot go.",
        promise="where the distance is None or nan, the speed is 0.0.",
        points=2,
        hints=(
            "There are two ways of not knowing.",
            "None, and math.nan: each deserves an assertion.",
        ),
    ),
    Line(
        id="back",
        covers=("back", "function-lines"),
        title="A test fails when the way back is guarded.",
        promise="a wanted speed of 0 or less is returned as it is, whatever is in front.",
        points=2,
        hints=(
            "The contract's lines have an order: the first that fits decides. "
            "Which line comes before the unknown ones?",
            "Ask for -0.3 m/s with a wall in front, and with each way of not knowing: None, and math.nan.",
        ),
    ),
    Line(
        id="chosen",
        covers=("chosen", "function-lines"),
        title="A test fails when a chosen stop_distance or slow_distance has no effect.",
        promise="stop_distance and slow_distance are the ends of the line.",
        points=2,
        hints=(
            "The defaults are only defaults.",
            "Choose both distances anew, far from 0.5 and 1.5, and ask on and beside the new line.",
            "0 is a stop_distance, too.",
        ),
    ),
    Line(
        id="refused",
        covers=("refused", "function-lines"),
        title="A test fails when distances that make no sense are accepted.",
        promise="it raises ValueError unless 0 <= stop_distance < slow_distance, whatever is wanted.",
        points=2,
        hints=(
            "with pytest.raises(ValueError): ...",
            "The condition has two parts: 0 <= stop_distance, and stop_distance < slow_distance. Equal ones break it.",
            "It is the first line of the contract: it counts on the way back, too.",
        ),
        doc=contract.RAISES,
    ),
)


@check_each_row(group("function", after=RIGHT_CHECK), LINES)
def expect_objection(line: Line, examination: Examination) -> None:
    """Fail the check unless the tests of the file fail on every version that breaks the line."""
    examination.expect_objection(line.id, line.promise)
