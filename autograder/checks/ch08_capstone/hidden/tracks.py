"""Signals of a robot's run for temporal formulas: its speed, its path, and its changes of direction."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from autograder.checks.ch02_nodes.hidden import blindness
from sim import Recording, Scan

Floats = NDArray[np.float64]

MIN_TURN_RATE = 0.05  # rad/s: a slower rotation is not a turn


@dataclass(frozen=True)
class LidarFault:
    """An interval of a drive, in seconds since its start, in which the lidar is dead or blocked."""

    name: str
    start: float
    end: float

    def covers(self, seconds: float) -> bool:
        """Return whether the fault affects a scan at this time."""
        return self.start <= seconds < self.end


def speeds(recording: Recording) -> Floats:
    """Return the true speed of the robot in m/s, one value for each state."""
    absolute: Floats = np.abs(recording.velocities[:, 0, 0])
    return absolute


def driven_since(recording: Recording, start: float) -> Floats:
    """Return the distance driven since a time in m: one value for each state, 0 before that time."""
    distances = blindness.driven_distances(recording)
    distance_at_start = float(np.interp(start, recording.times, distances))
    return np.where(recording.times < start, 0.0, distances - distance_at_start)


def changes_of_direction(times: Sequence[float], rates: Sequence[float], window: float) -> list[float]:
    """For each command, count how often a turn in the last `window` seconds followed one to the other side.

    Args:
        times: the times of the commands in seconds, in ascending order.
        rates: their turn rates in rad/s; left is positive.
        window: the length of the time before each command, in seconds.
    """
    change_times: list[float] = []
    side = 0.0
    counts = []
    for now, rate in zip(times, rates, strict=True):
        if abs(rate) > MIN_TURN_RATE:
            if side * rate < 0:
                change_times.append(now)
            side = math.copysign(1.0, rate)
        counts.append(float(sum(now - change <= window for change in change_times)))
    return counts


def blocked_scan(scan: Scan) -> Scan:
    """Return the scan of a blocked lidar, in which every reading is nan."""
    return replace(scan, ranges=np.full_like(scan.ranges, np.nan))
