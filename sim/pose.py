"""Poses of robots, and velocity commands."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Pose:
    """A position and a heading in the frame `map` (REP 103: x forward, y left, theta anticlockwise).

    `x` and `y` are in metres, `theta` in radians.
    """

    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0


@dataclass(frozen=True, slots=True)
class Command:
    """The velocities in a Twist for a differential drive: `linear` in m/s along x of base_link, `angular` in rad/s."""

    linear: float = 0.0
    angular: float = 0.0


ORIGIN = Pose()
REST = Command()
