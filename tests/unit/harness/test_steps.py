"""The length of a step of ROS time."""

from __future__ import annotations

import pytest

from autograder.harness.drive import SCAN_NS
from autograder.harness.steps import FINEST_TICK_NS, TICK_NS, next_instant, tick_of

MS = 1_000_000


@pytest.mark.parametrize("tick_ns", [TICK_NS, FINEST_TICK_NS])
def test_each_scan_comes_at_the_end_of_a_step(tick_ns: int) -> None:
    assert SCAN_NS % tick_ns == 0


@pytest.mark.parametrize(
    ("timers", "tick"),
    [
        ([], TICK_NS),
        ([500 * MS], TICK_NS),
        ([150 * MS], 50 * MS),
        ([20 * MS, 30 * MS], 10 * MS),
        ([7 * MS], FINEST_TICK_NS),
    ],
    ids=["no timer", "longer", "every firing is hit", "of several", "never finer"],
)
def test_a_tick_hits_every_firing_of_the_timers(timers: list[int], tick: int) -> None:
    assert tick_of(TICK_NS, timers) == tick


@pytest.mark.parametrize(
    ("wake_ups", "instant"),
    [
        ([], 100 * MS),
        ([None, 250 * MS], 100 * MS),
        ([60 * MS, 40 * MS], 40 * MS),
        ([3 * MS], FINEST_TICK_NS),
        ([99 * MS + 1], 100 * MS),
    ],
    ids=["no wake-up", "later", "the first", "not at once", "just before the end"],
)
def test_a_step_ends_early_at_a_pending_wake_up(wake_ups: list[int | None], instant: int) -> None:
    assert next_instant(0, 100 * MS, wake_ups) == instant
