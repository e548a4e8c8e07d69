"""Where a robot is, and what it is told to do: the two smallest values of the simulator."""

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
    """What a Twist asks of a differential drive: `linear` in m/s along x of base_link, `angular` in rad/s about z."""

    linear: float = 0.0
    angular: float = 0.0


ORIGIN = Pose()
REST = Command()
