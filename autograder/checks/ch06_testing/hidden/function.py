"""Tests of the pure function: do they notice when safe_speed breaks its contract?"""

from __future__ import annotations

from autograder.checks import group, hint
from autograder.checks.ch06_testing.hidden.examination import BACKWARDS, SECOND, Examination
from autograder.checks.ch06_testing.support import contract
from autograder.checks.ch06_testing.support.contract import LIMITS
from autograder.checks.ch06_testing.support.verdicts import expect_passed

check = group("function")
RIGHT = ("limits_right",)


@check(points=2, doc=contract.PYTEST)
@hint("Run them: colcon test, or python -m pytest test/test_limits.py in the package's folder.", contract.ALL_PASS)
def test_limits_pass(examination: Examination) -> None:
    """At least six tests in test_limits.py run, and all pass on the package as it is."""
    expect_passed(LIMITS, examination.trial.get(LIMITS))


@check(points=1, depends=("limits_pass",), doc=contract.APPROX)
@hint("Other people may write safe_speed in other words: only the contract in its docstring is sure.")
@hint("Floats that are worked out in another order differ in the last digit: pytest.approx.")
def test_limits_right(examination: Examination) -> None:
    """They pass on every right safe_speed, in any order."""
    examination.expect_right(LIMITS, SECOND, BACKWARDS)


@check(points=1, depends=RIGHT, doc=contract.PYTEST)
@hint("What does it return for a wall at 0.3 m, exactly?", contract.MUTATE)
def test_stop(examination: Examination) -> None:
    """A test fails when the robot does not stand still in front of near things."""
    examination.expect_objection("stop", "at stop_distance and nearer, the speed is 0.0, not a little more or less.")


@check(points=2, depends=RIGHT, doc=contract.APPROX)
@hint("One point between the two distances shows that it slows down; two show that the line is straight.")
@hint("Half-way, and at a quarter: assert safe_speed(0.8, 0.75) == pytest.approx(0.2).")
def test_slow(examination: Examination) -> None:
    """A test fails when the speed between the two distances is not on a straight line."""
    examination.expect_objection("slow", "between the two distances the speed grows in a straight line.")


@check(points=1, depends=RIGHT, doc=contract.APPROX)
@hint("What does it return for a wall at 4 m, exactly? Not only: more than 0.", contract.MUTATE)
def test_clear(examination: Examination) -> None:
    """A test fails when far things change the speed."""
    examination.expect_objection("clear", "at slow_distance and farther, the speed is the wanted one.")


@check(points=1, depends=RIGHT, doc=contract.REP_117)
@hint("A sensor that sees nothing says inf.", "assert safe_speed(0.8, math.inf) == ...")
def test_infinity(examination: Examination) -> None:
    """A test fails when "nothing ahead" is not a clear way."""
    examination.expect_objection("infinity", "a distance of inf is a clear way.")


@check(points=2, depends=RIGHT, doc=contract.PYTEST)
@hint("There are two ways of not knowing.", "None, and math.nan: each deserves an assertion.")
def test_unknown(examination: Examination) -> None:
    """A test fails when an unknown distance lets the robot go."""
    examination.expect_objection("unknown", "where the distance is None or nan, the speed is 0.0.")


@check(points=2, depends=RIGHT, doc=contract.PYTEST)
@hint("The contract's lines have an order: the first that fits decides. Which line comes before the unknown ones?")
@hint("Ask for -0.3 m/s with a wall in front, and with no distance at all.")
def test_back(examination: Examination) -> None:
    """A test fails when the way back is guarded."""
    examination.expect_objection("back", "a wanted speed of 0 or less is returned as it is, whatever is in front.")


@check(points=2, depends=RIGHT, doc=contract.PYTEST)
@hint("The defaults are only defaults.")
@hint("Choose both distances anew, far from 0.5 and 1.5, and ask on and beside the new line.")
def test_chosen(examination: Examination) -> None:
    """A test fails when a chosen stop_distance or slow_distance has no effect."""
    examination.expect_objection("chosen", "stop_distance and slow_distance are the ends of the line.")


@check(points=2, depends=RIGHT, doc=contract.RAISES)
@hint("with pytest.raises(ValueError): ...")
@hint("The condition has two parts: 0 <= stop_distance, and stop_distance < slow_distance.")
def test_refused(examination: Examination) -> None:
    """A test fails when distances that make no sense are accepted."""
    examination.expect_objection("refused", "it raises ValueError unless 0 <= stop_distance < slow_distance.")
