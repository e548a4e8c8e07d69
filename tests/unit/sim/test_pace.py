"""Simulated time follows real time in small parts, so that commands are seen in between."""

from __future__ import annotations

import pytest

from sim.bridge.pace import MAX_BACKLOG, MAX_BATCH, PERIOD, Pace


def advance(pace: Pace, now: float, speed: float) -> float:
    """Read the clock, and advance by the time that is due."""
    seconds = pace.due(now, speed)
    pace.count_simulated(seconds)
    return seconds


def test_time_starts_with_the_first_call() -> None:
    pace = Pace(0.02)
    assert advance(pace, 1000.0, 2.0) == 0.0
    assert not pace.is_late
    assert advance(pace, 1000.01, 2.0) == pytest.approx(0.02)


@pytest.mark.parametrize("speed", [1.0, 2.0])
def test_a_delay_is_caught_up_in_parts_shorter_than_a_watchdog(speed: float) -> None:
    pace = Pace(0.02)
    advance(pace, 0.0, speed)
    parts = [advance(pace, 0.2, speed) for _ in range(10)]
    assert max(parts) == MAX_BATCH
    assert sum(parts) == pytest.approx(0.2 * speed)
    assert not pace.is_late


def test_a_delay_beyond_the_longest_leap_is_reported_and_dropped() -> None:
    pace = Pace(0.02)
    advance(pace, 0.0, 2.0)
    first = advance(pace, 60.0, 2.0)
    assert pace.is_late
    assert first + sum(advance(pace, 60.0, 2.0) for _ in range(100)) == pytest.approx(MAX_BACKLOG * 2.0 + 0.02)
    assert not pace.is_late


@pytest.mark.parametrize(("tick", "speed"), [(1.0, 0.1), (0.02, 1000.0)])
def test_long_ticks_and_high_speeds_are_reached(tick: float, speed: float) -> None:
    pace = Pace(tick)
    advanced = sum(advance(pace, number * PERIOD, speed) for number in range(3001))
    assert advanced == pytest.approx(30.0 * speed)


def test_the_time_of_a_pause_or_a_new_start_is_not_caught_up() -> None:
    pace = Pace(0.02)
    advance(pace, 0.0, 1.0)
    assert pace.due(5.0, 1.0, paused=True) == 0.0
    assert pace.due(5.1, 1.0) == pytest.approx(0.1)
    pace.clear()
    assert pace.due(5.1, 1.0) == 0.0
