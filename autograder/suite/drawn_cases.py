"""Tests a rule with drawn cases, and reports the simplest case that violates it.

    @st.composite
    def walls(draw: st.DrawFn) -> Wall: ...

    def test_turns(robot: Robot, draw: random.Random) -> None:
        expect_each(walls(), partial(expect_turn, robot), draw)

Hypothesis draws the cases from a strategy that covers everything that the contract allows, and simplifies a case that
fails. Random generators with the same seed draw the same cases.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any, TypeVar

from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis.errors import Flaky
from hypothesis.internal.conjecture import providers
from hypothesis.strategies import DrawFn, SearchStrategy, composite

from autograder.suite.declaration import CheckFailed

Case = TypeVar("Case")
# Hypothesis would also draw constants from all modules that are loaded. The cases would then depend on these modules,
# and reading them takes half a second.
providers._get_local_constants = lambda: providers._local_constants
# The maximum number of attempts to draw a simpler case: in total, and for each case that the check draws. A check that
# draws few cases, because each takes long, does not spend a submission's time on shrinking.
SHRINKS, SHRINKS_PER_CASE = 200, 5


def expect_each(
    cases: SearchStrategy[Case], judge: Callable[[Case], None], draw: random.Random, *, count: int = 60
) -> None:
    """Fail the check with the simplest case found for which `judge` raises CheckFailed.

    A program that keeps state can violate the rule because of the previous case. So the case that fails first is judged
    a second time. If it then passes, it is not simplified, but reported together with the previous case. A case that
    has passed is not judged again: Hypothesis demands the same result for the same case.

    Args:
        cases: draws the cases. Different cases have a different `repr`.
        judge: runs the student's program with a case, and raises CheckFailed if its behaviour is wrong. Any other
            exception ends the check.
        draw: the check's random generator.
        count: how many cases are judged if none fails.

    Raises:
        CheckFailed: a case failed.
    """
    run = _Run(judge, min(SHRINKS, SHRINKS_PER_CASE * count))
    decorate = settings(
        max_examples=count,
        database=None,  # a grading leaves nothing for the next one
        deadline=None,
        derandomize=False,
        phases=(Phase.generate, Phase.shrink),
        report_multiple_bugs=False,
        suppress_health_check=list(HealthCheck),
        print_blob=False,
    )
    try:
        seed(draw.getrandbits(64))(decorate(given(_counted(cases, run))(run.judge)))()
    except (CheckFailed, _Finished, Flaky):  # `_Finished` ends the last attempt, which may look flaky to Hypothesis
        assert run.result is not None
        raise run.result from None


@composite
def _counted(draw: DrawFn, cases: SearchStrategy[Case], run: _Run) -> Case:
    run.begin()
    return draw(cases)


class _Finished(BaseException):
    """Ends Hypothesis. It is not an Exception, because Hypothesis would regard that as the failure of a case."""


class _Run:
    """Judges cases until the budget for shrinking is spent.

    Attributes:
        result: the failure of the simplest case so far, or the exception that ended the run.
    """

    def __init__(self, judge: Callable[[Any], None], shrinks: int) -> None:
        self._judge = judge
        self._failures: dict[str, CheckFailed] = {}
        self._passed: set[str] = set()
        self._previous_case = ""
        self._budget = shrinks
        self.result: BaseException | None = None

    def begin(self) -> None:
        """Count an attempt to draw a case, and end the run after the last one. Few attempts find a simpler case."""
        if self._failures:
            self._budget -= 1
        if self._budget < 0:
            raise _Finished

    def judge(self, case: object) -> None:
        """Judge a case. Hypothesis runs this as its test."""
        text = repr(case)
        if text not in self._failures:
            if text in self._passed:
                return
            try:
                self._judge(case)
                self._passed.add(text)
            except CheckFailed as failure:
                self._failures[text] = failure if self._failures else self._confirm(case, failure)
            except BaseException as error:
                self.result = error
                raise _Finished from None
            finally:
                self._previous_case = text
        if text in self._failures:
            # Hypothesis tries only simpler cases than the simplest that has failed.
            self.result = self._failures[text]
            raise self.result

    def _confirm(self, case: object, failure: CheckFailed) -> CheckFailed:
        try:
            self._judge(case)
        except CheckFailed as second:
            return second
        self._budget = 0
        addition = f" It did so right after another case, {self._previous_case}." if self._previous_case else ""
        return CheckFailed(failure.message + addition, fraction=failure.fraction, hints=failure.hints)
