"""The usual rate of messages is also correct on a busy machine."""

from __future__ import annotations

import pytest

from autograder.harness.real_time import usual_rate

STEADY = [0.1 * number for number in range(1, 21)]


@pytest.mark.parametrize(
    ("instants", "rate"),
    [
        pytest.param(STEADY, 10.0, id="steady"),
        pytest.param(STEADY[:8] + STEADY[12:], 10.0, id="stalled for half a second"),
        pytest.param(STEADY[::2], 5.0, id="half as often"),
        pytest.param(STEADY[:8], 4.0, id="it stopped after 0.8 s"),
        pytest.param([], 0.0, id="never"),
        pytest.param([0.3, 0.4], 1.0, id="twice"),
    ],
)
def test_the_usual_rate_is_that_of_the_median_interval(instants: list[float], rate: float) -> None:
    assert usual_rate(instants, 2.0) == pytest.approx(rate)


def test_messages_sent_twice_in_each_period_have_a_higher_usual_rate() -> None:
    assert usual_rate(sorted([*STEADY, *(instant + 0.001 for instant in STEADY)]), 2.0) > 11.0
