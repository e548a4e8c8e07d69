"""Checks that the tests of the function pass on a correct safe_speed, and fail if it breaks its contract."""

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
@hint("Other people may write safe_speed differently: rely only on the contract in its docstring.")
@hint("Floats that are computed in another order may differ in the last digit: use pytest.approx.")
def test_limits_right(examination: Examination) -> None:
    """The tests in test_limits.py pass on every correct safe_speed, in any order."""
    examination.expect_passed_on_correct_versions(LIMITS, BACKWARDS)


LINES = (
    Line(
        id="stop",
        covers=("stop", "function-lines"),
        title="A test fails when the robot does not stand still in front of near things.",
        promise="at stop_distance and nearer, the speed is 0.0, not a little more or less.",
        points=1,
        hints=(
            "What exactly does it return for a wall at 0.3 m?",
            contract.MUTATE,
        ),
    ),
    Line(
        id="slow",
        covers=("slow", "function-lines"),
        title="A test fails when the speed between the two distances does not grow in a straight line.",
        promise="between the two distances, the speed grows linearly.",
        points=2,
        hints=(
            "One point between the two distances shows that it slows down; two show that the line is straight.",
            "Test half-way, and at a quarter of the way: assert safe_speed(0.8, 0.75) == pytest.approx(0.2).",
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
            "What exactly does it return for a wall at 4 m, and at slow_distance itself? `> 0.0` is not enough.",
            contract.MUTATE,
        ),
        doc=contract.APPROX,
    ),
    Line(
        id="infinity",
        covers=("infinity", "function-lines"),
        title='A test fails when "nothing ahead" does not count as a clear way.',
        promise="a distance of inf means that the way is clear.",
        points=1,
        hints=(
            "A sensor that sees nothing reports inf.",
            "assert safe_speed(0.8, math.inf) == ...",
        ),
        doc=contract.REP_117,
    ),
    Line(
        id="unknown",
        covers=("unknown", "function-lines"),
        title="A test fails when an unknown distance lets the robot move.",
        promise="if the distance is None or nan, the speed is 0.0.",
        points=2,
        hints=(
            "A distance can be unknown in two ways.",
            "None and math.nan: write an assertion for each.",
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
            "Which line comes before the one about unknown distances?",
            "Ask for -0.3 m/s with a wall in front, and with each unknown distance: None and math.nan.",
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
            "Choose two other distances, far from 0.5 and 1.5. Test between them, nearer and farther.",
            "0 is a valid stop_distance, too.",
        ),
    ),
    Line(
        id="refused",
        covers=("refused", "function-lines"),
        title="A test fails when distances that make no sense are accepted.",
        promise="for every wanted speed, ValueError is raised unless 0 <= stop_distance < slow_distance.",
        points=2,
        hints=(
            "with pytest.raises(ValueError): ...",
            "The condition has two parts: 0 <= stop_distance, and stop_distance < slow_distance. "
            "Equal distances break the second part.",
            "It is the first line of the contract, so it also applies on the way back.",
        ),
        doc=contract.RAISES,
    ),
)


@check_each_row(group("function", after=RIGHT_CHECK), LINES)
def expect_detection(line: Line, examination: Examination) -> None:
    """Fail the check unless the tests of the file fail on every version that breaks the line."""
    examination.expect_detection(line.id, line.promise)
