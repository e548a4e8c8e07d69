"""A differential drive robot: what it is (`RobotSpec`) and how it stands at one instant (`RobotState`)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from sim.faults import NO_FAULTS, Faults
from sim.lidar import LDS_01, LidarSpec
from sim.pose import ORIGIN, REST, Command, Pose

if TYPE_CHECKING:
    from sim.state import State

Covariance = tuple[float, float, float, float, float, float, float, float, float]


@dataclass(frozen=True, slots=True)
class OdometryDrift:
    """How wheel odometry goes astray; all zeros is a perfect one.

    The measured motion of a tick has a variance that grows with the motion: `linear` in m of standard deviation
    for a metre driven, `angular` in rad for a radian turned, `veer` in rad for a metre driven.
    """

    linear: float = 0.0
    angular: float = 0.0
    veer: float = 0.0


NO_DRIFT = OdometryDrift()


@dataclass(frozen=True, slots=True)
class RobotSpec:
    """A robot: its footprint, its limits, its watchdog, its lidar.

    `radius` is that of a round footprint in metres; `footprint`, if given, is a convex polygon of points in
    `base_link` instead. Limits are in m/s, rad/s, m/s² and rad/s². `watchdog` is the simulated time in seconds
    after which a robot without a new command stops. `start` is where it starts; None takes the world's start pose
    of the robot's index. `on_collision` is what a contact does to the motion.
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


@dataclass(frozen=True, slots=True)
class RobotState:
    """One robot at one instant.

    `pose` is the truth in the frame `map`; `velocity` what it does now, in m/s and rad/s; `command` the last one
    received, at `command_ns`; `odometry` the pose by its wheels in the frame `odom` (which starts at the start
    pose), with `covariance` over (x, y, theta), 3 x 3 row by row in m², m rad and rad². `collided` is true while
    something blocks it; `collisions` counts the contacts so far. `held` is the state in which a frozen lidar froze.
    """

    name: str
    pose: Pose
    velocity: Command = REST
    command: Command = REST
    command_ns: int = 0
    odometry: Pose = ORIGIN
    covariance: Covariance = (0.0,) * 9
    collided: bool = False
    collisions: int = 0
    held: State | None = None
