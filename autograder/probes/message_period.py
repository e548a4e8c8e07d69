"""How often messages come, and whether that is what a contract asks."""

from __future__ import annotations

import math
from collections.abc import Sequence

from autograder.harness import ReceivedMessage
from autograder.time_record import LOCKSTEP, REAL

# Of the period. In lockstep an error of a tenth is seen; in real time a busy machine holds messages up.
TOLERANCES = {LOCKSTEP: 0.08, REAL: 0.25}


def mean_period(messages: Sequence[ReceivedMessage]) -> float:
    """Return the mean time between messages in s; infinity if there are fewer than two."""
    return (messages[-1].seconds - messages[0].seconds) / (len(messages) - 1) if len(messages) > 1 else math.inf


def is_paced(seen: float, wanted: float, time: str) -> bool:
    """Return whether a mean period in s is the wanted one; `time` is the harness's, "lockstep" or "real"."""
    return abs(seen - wanted) <= TOLERANCES[time] * wanted
