"""Measures how often messages are published, and compares this with the contract."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from statistics import median

from autograder.harness import ReceivedMessage
from autograder.run.time_record import LOCKSTEP, REAL

TOLERANCE = 0.08  # share of the period; small enough to detect an error of 10 %
JITTER = {LOCKSTEP: 0.0, REAL: 0.01}  # s, added to the tolerance of each pause
# The share of the pauses between messages that have to be correct. In real time, a busy machine delays some messages,
# and the pauses before and after each of these are wrong.
MIN_SHARE = {LOCKSTEP: 0.9, REAL: 0.5}
MAX_FACTOR = 2.0  # the longest mean pause in real time, in periods; messages may get lost


def mean_period(messages: Sequence[ReceivedMessage]) -> float:
    """Return the mean time between messages in s, or infinity for fewer than two."""
    return (messages[-1].seconds - messages[0].seconds) / (len(messages) - 1) if len(messages) > 1 else math.inf


def is_paced(messages: Sequence[ReceivedMessage], period: float, time: str) -> bool:
    """Return whether messages were received one by one, with a pause of `period` s between them.

    Two messages at once followed by a double pause are wrong, although their number is correct. In real time, the
    tolerance is larger for single pauses, but not for the median, because a program can choose to run in real time.

    Args:
        messages: two or more messages, in the order in which they were received.
        period: the period in s.
        time: the time of the harness, "lockstep" or "real".
    """
    tolerance = TOLERANCE * period + JITTER[time]
    pauses = [after.seconds - before.seconds for before, after in pairwise(messages)]
    is_correct = [abs(pause - period) <= tolerance for pause in pauses]
    # A few late messages do not change the median.
    if not is_correct or abs(median(pauses) - period) > TOLERANCE * period:
        return False
    mean = mean_period(messages)
    longest = MAX_FACTOR * period if time == REAL else period + tolerance
    return sum(is_correct) >= MIN_SHARE[time] * len(is_correct) and period - tolerance <= mean <= longest


def describe_pace(messages: Sequence[ReceivedMessage]) -> str:
    """Describe the period: "every 0.20 s", or "every 0.10 s on average, with pauses of 0.00 s to 0.20 s"."""
    pauses = [after.seconds - before.seconds for before, after in pairwise(messages)]
    if not pauses:
        return "once" if messages else "not at all"
    mean = f"every {mean_period(messages):.2f} s"
    if max(pauses) - min(pauses) <= TOLERANCE * max(pauses):
        return mean
    return f"{mean} on average, with pauses of {min(pauses):.2f} s to {max(pauses):.2f} s"
