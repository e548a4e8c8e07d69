"""Temporal logic over traces: the robustness of a formula, and the instant at which it is violated."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from autograder.suite import CheckFailed
from autograder.suite.temporal import always

TIMES = [0.0, 0.5, 1.0, 1.5]


def test_a_fulfilled_condition_has_a_robustness_and_no_instant() -> None:
    verdict = always("gap > 0.1", TIMES, {"gap": [1.0, 0.4, 0.3, 0.6]})
    assert verdict.robustness == pytest.approx(0.2)
    assert verdict.violated_at is None


def test_the_first_instant_of_a_violation_is_named_in_the_trace_s_own_time() -> None:
    verdict = always("gap > 0.1", TIMES, {"gap": [1.0, 0.1, 0.3, -0.2]})
    assert verdict.violated_at == 0.5
    assert verdict.robustness == pytest.approx(-0.3)


def test_formulas_combine_signals_and_look_ahead_by_samples() -> None:
    formula = "(blocked > 0.5) implies (eventually[0:1] (turn > 0.4))"
    signals = {"blocked": [0.0, 1.0, 0.0, 0.0], "turn": [0.0, 0.0, 0.5, 0.0]}
    assert always(formula, TIMES, signals).violated_at is None
    assert always(formula, TIMES, {**signals, "turn": [0.0, 0.0, 0.0, 0.5]}).violated_at == 0.5


def test_a_malformed_formula_is_an_error() -> None:
    import rtamt  # autograder.suite.temporal has made this possible on each version of Python

    with pytest.raises(rtamt.RTAMTException):
        always("gap >", TIMES, {"gap": [1.0] * 4})


@settings(deadline=None, max_examples=25)
@given(st.lists(st.floats(-10, 10), min_size=2, max_size=20))
def test_always_agrees_with_the_definition_of_robustness(gaps: list[float]) -> None:
    verdict = always("gap > 1.0", list(range(len(gaps))), {"gap": gaps})
    first = next((index for index, gap in enumerate(gaps) if gap - 1.0 <= 0.0), None)
    assert verdict.robustness == pytest.approx(min(gaps) - 1.0)
    assert verdict.violated_at == first


def test_a_trace_of_fewer_than_two_samples_fails_the_check() -> None:
    with pytest.raises(CheckFailed, match="Fewer than two messages were received"):
        always("gap > 0.1", [0.5], {"gap": [1.0]})
