"""A differential drive robot: its size, its limits, its lidar, its odometry drift and its faults."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

from sim.exceptions import SpecError
from sim.faults import NO_FAULTS, Faults
from sim.lidar import LDS_01, LidarSpec
from sim.pose import Pose

CONVEX = "three points or more of a convex polygon around (0, 0), anticlockwise, in metres"


@dataclass(frozen=True, slots=True)
class OdometryDrift:
    """The errors of wheel odometry, which is perfect if all of them are zero.

    The variance of the motion measured in a tick grows with the motion. The standard deviation is `linear` in m for a
    metre driven, `angular` in rad for a radian turned, and `veer` in rad for a metre driven.
    """

    linear: float = 0.0
    angular: float = 0.0
    veer: float = 0.0

    def __post_init__(self) -> None:
        for name in ("linear", "angular", "veer"):
            if not 0.0 <= getattr(self, name) <= 10.0:
                raise SpecError(f"drift: {name} is {getattr(self, name)}; give a standard deviation from 0 to 10")


NO_DRIFT = OdometryDrift()


@dataclass(frozen=True, slots=True)
class RobotSpec:
    """A robot: its footprint, limits, watchdog and lidar.

    `radius` is the radius of a round footprint in metres. `footprint`, if given, is a convex polygon of points in
    `base_link` that replaces the circle. Limits are in m/s, rad/s, m/s² and rad/s². `watchdog` is the simulated time in
    seconds after which a robot without a new command stops. `start` is its start pose; if it is None, the world's start
    pose with the robot's index is used. `on_collision` is the effect of a contact on the motion.
    """

    name: str = "robot"
    namespace: str = ""
    radius: float = 0.105
    footprint: tuple[tuple[float, float], ...] | None = None
    max_linear: float = 0.5
    max_angular: float = 2.84
    max_linear_acceleration: float = 2.5
    max_angular_acceleration: float = 10.0
    watchdog: float = 0.5
    lidar: LidarSpec | None = LDS_01
    drift: OdometryDrift = NO_DRIFT
    faults: Faults = NO_FAULTS
    on_collision: Literal["stop", "slide"] = "stop"
    start: Pose | None = None

    def __post_init__(self) -> None:
        for name, is_valid, remedy in (
            ("name", bool(self.name) and self.name.isprintable(), "a short text"),
            ("radius", 0.01 <= self.radius <= 10.0, "metres, from 0.01 to 10"),
            ("max_linear", 0.0 <= self.max_linear <= 100.0, "m/s, from 0 to 100"),
            ("max_angular", 0.0 <= self.max_angular <= 100.0, "rad/s, from 0 to 100"),
            ("max_linear_acceleration", self.max_linear_acceleration > 0.0, "m/s², above 0; inf for none"),
            ("max_angular_acceleration", self.max_angular_acceleration > 0.0, "rad/s², above 0; inf for none"),
            ("watchdog", self.watchdog > 0.0, "seconds, above 0; inf for none"),
            ("on_collision", self.on_collision in ("stop", "slide"), "'stop' or 'slide'"),
            ("start", self.start is None or _finite(self.start), "a pose of finite numbers"),
            ("footprint", self.footprint is None or _convex(self.footprint), CONVEX),
        ):
            if not is_valid:
                raise SpecError(f"robot {self.name!r}: {name} is {getattr(self, name)!r}; give {remedy}")


def _finite(pose: Pose) -> bool:
    return all(map(math.isfinite, (pose.x, pose.y, pose.theta)))


def _convex(points: tuple[tuple[float, float], ...]) -> bool:
    """Return whether the polygon turns left at each corner and goes round the origin once."""
    if len(points) < 3 or not all(math.isfinite(x) and math.isfinite(y) for x, y in points):
        return False
    sides = list(pairwise([*points, points[0]]))
    directions = [(b[0] - a[0], b[1] - a[1]) for a, b in sides]
    turns = [
        math.atan2(p[0] * q[1] - p[1] * q[0], p[0] * q[0] + p[1] * q[1])
        for p, q in pairwise([*directions, directions[0]])
    ]
    left_of_all = all(a[0] * b[1] - a[1] * b[0] > 0.0 for a, b in sides)
    return left_of_all and all(turn > 0.0 for turn in turns) and sum(turns) < 1.01 * math.tau
