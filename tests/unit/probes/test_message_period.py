"""Evenly spaced messages are distinguished from as many messages in pairs, in lockstep and in real time."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate

import pytest

from autograder.harness import ReceivedMessage
from autograder.probes.message_period import describe_pace, is_paced
from autograder.run.time_record import LOCKSTEP, REAL

PERIOD = 0.1  # s
STEADY = [PERIOD] * 40


def _after(pauses: Sequence[float]) -> list[ReceivedMessage]:
    return [ReceivedMessage(seconds, None) for seconds in accumulate(pauses, initial=1.0)]


@pytest.mark.parametrize("time", [LOCKSTEP, REAL])
def test_messages_with_the_right_pauses_are_paced(time: str) -> None:
    assert is_paced(_after(STEADY), PERIOD, time)


@pytest.mark.parametrize("time", [LOCKSTEP, REAL])
@pytest.mark.parametrize(
    "pauses",
    [
        [0.0, 0.2] * 20,
        [0.2, 0.0] * 20,
        [0.0, 0.0, 0.3] * 14,
        [0.12] * 40,
        [0.08] * 40,
        [0.2] * 20,
        [0.0] * 40,
        [0.1] + [0.5] * 7,
        [0.11] * 40,
        [0.09] * 40,
        [0.1, 0.12, 0.115, 0.11, 0.105] * 8,
    ],
    ids=[
        *("pairs", "pairs later", "threes", "a fifth longer", "a fifth shorter", "half as many", "at once", "seldom"),
        *("a tenth longer", "a tenth shorter", "a tenth longer, unevenly"),
    ],
)
def test_messages_with_other_pauses_are_not_paced_in_either_time(pauses: Sequence[float], time: str) -> None:
    assert not is_paced(_after(pauses), PERIOD, time)


@pytest.mark.parametrize("period", [1.2, 1.1, 0.9])
def test_a_period_of_a_second_is_checked_to_a_tenth_in_real_time_too(period: float) -> None:
    assert not is_paced(_after([period] * 6), 1.0, REAL)


def test_a_machine_that_delays_some_messages_in_real_time_costs_no_points() -> None:
    delays = [0.1, 0.18, 0.02, 0.1, 0.1, 0.35, 0.0, 0.1, 0.105, 0.095] * 4
    assert is_paced(_after(delays), PERIOD, REAL)
    assert not is_paced(_after(delays), PERIOD, LOCKSTEP)


@pytest.mark.parametrize("count", [0, 1])
def test_fewer_than_two_messages_have_no_pace(count: int) -> None:
    assert not is_paced(_after([])[:count], PERIOD, LOCKSTEP)


@pytest.mark.parametrize(
    ("messages", "description"),
    [
        (_after([0.2] * 20), "every 0.20 s"),
        (_after([0.0, 0.2] * 20), "every 0.10 s on average, with pauses of 0.00 s to 0.20 s"),
        (_after([]), "once"),
        ([], "not at all"),
    ],
)
def test_a_pace_is_described_in_words(messages: Sequence[ReceivedMessage], description: str) -> None:
    assert describe_pace(messages) == description
