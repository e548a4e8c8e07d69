"""Tests whether a robot's track shows that it reacts to its lidar. Even a robot that ignores it may touch nothing."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from sim import Recording

Floats = NDArray[np.float64]

MIN_TURN_RATE = 0.1  # rad/s: a robot with a lower rate drives straight on or stands still
HALF_SECTOR = math.radians(30.0)


def driven_distances(recording: Recording) -> Floats:
    """Return the distance in metres that the robot had driven at each recorded state."""
    steps = np.hypot(*np.diff(recording.poses[:, 0, :2], axis=0).T)
    return np.concatenate(([0.0], np.cumsum(steps)))


def turns_at_obstacles(recording: Recording, within: float, until: float = math.inf) -> bool:
    """Return whether the robot turned, and had an obstacle close ahead for at least half of the time that it turned.

    Args:
        recording: a run of one robot with a lidar.
        within: how far ahead an obstacle counts, in metres; somewhat more than the distance at which the robot turns.
        until: a time in seconds; turns after it do not count.
    """
    log, lidar = recording.scans[0], recording.simulation.robots[0].lidar
    assert lidar is not None
    bearings = lidar.angle_min + lidar.angle_increment * np.arange(lidar.beams)
    is_ahead = np.abs(np.remainder(bearings + math.pi, math.tau) - math.pi) <= HALF_SECTOR
    nearest = np.nan_to_num(log.ranges[:, is_ahead], nan=np.inf, posinf=np.inf, neginf=0.0).min(axis=1)
    is_turning = (np.abs(recording.velocities[log.rows, 0, 1]) > MIN_TURN_RATE) & (recording.times[log.rows] <= until)
    return bool(is_turning.any() and (nearest[is_turning] < within).mean() >= 0.5)
