"""Signals over a robot's run, for formulas to judge: how far it went in the dark, how often it changed its mind."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from autograder.checks.ch02_nodes.hidden import blindness
from sim import Recording, Scan

Floats = NDArray[np.float64]

TURNS = 0.05  # rad/s: anything slower is no turn


@dataclass(frozen=True)
class LidarFault:
    """A stretch of a drive, in seconds since its start, in which the lidar is dead or blocked."""

    name: str
    start: float
    end: float

    def covers(self, seconds: float) -> bool:
        """Return whether a scan of that time is concerned."""
        return self.start <= seconds < self.end


def speeds(recording: Recording) -> Floats:
    """Return how fast the robot really moves, m/s, one value a state."""
    found: Floats = np.abs(recording.velocities[:, 0, 0])
    return found


def driven_since(recording: Recording, start: float) -> Floats:
    """Return the metres driven since a time, one value a state, 0 before it."""
    metres = blindness.path(recording)
    at_start = float(np.interp(start, recording.times, metres))
    return np.where(recording.times < start, 0.0, metres - at_start)


def changes_of_mind(times: Sequence[float], rates: Sequence[float], within: float) -> list[float]:
    """Count how often a turn followed one to the other side, in the newest `within` seconds; one value a command.

    Args:
        times: of the commands, seconds, rising.
        rates: their turn rates, rad/s, left is positive.
        within: seconds.
    """
    changed: list[float] = []
    side = 0.0
    counts = []
    for now, rate in zip(times, rates, strict=True):
        if abs(rate) > TURNS:
            if side * rate < 0:
                changed.append(now)
            side = math.copysign(1.0, rate)
        counts.append(float(sum(now - when <= within for when in changed)))
    return counts


def blocked(scan: Scan) -> Scan:
    """Return the scan of a lidar with a hand in front of it: no reading counts."""
    return replace(scan, ranges=np.full_like(scan.ranges, np.nan))
