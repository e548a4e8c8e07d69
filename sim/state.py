"""The parameters of a run, and its state at one instant, as frozen data without globals or a hidden clock."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

from sim.engine import EngineName, engine
from sim.exceptions import SpecError
from sim.pose import ORIGIN, REST, Command, Pose
from sim.robot import RobotSpec
from sim.scene import Scene, build
from sim.world import World

Commands = Mapping[str, Command] | Command | None
Covariance = tuple[float, float, float, float, float, float, float, float, float]


@dataclass(frozen=True, slots=True)
class Event:
    """An event at the point (`x`, `y`) of the frame `map`, which `what` describes.

    `kind` is "collision", with the `speed` of the impact in m/s, or "watchdog".
    """

    time_ns: int
    robot: str
    kind: str
    what: str
    x: float
    y: float
    speed: float = 0.0


@dataclass(frozen=True)
class Simulation:
    """The parameters of a run: a world, robots and a seed. A simulation is immutable.

    `tick` is the physics period in seconds. `engine` is "numpy", "numba" (which needs the extra `fast`) or "auto"
    (numba if it is installed). All engines compute the same states and scans, bit for bit.

    Raises a SpecError if two robots have the same name, or a value is invalid.
    """

    world: World
    robots: tuple[RobotSpec, ...] = (RobotSpec(),)
    seed: int = 0
    tick: float = 0.02
    engine: EngineName = "numpy"

    def __post_init__(self) -> None:
        object.__setattr__(self, "robots", tuple(self.robots))
        names = [robot.name for robot in self.robots]
        if not names:
            raise SpecError("a simulation needs a robot; give robots=(RobotSpec(),)")
        if len(set(names)) < len(names):
            raise SpecError(f"two robots have the same name: {', '.join(names)}; give each its own")
        if not 1e-4 <= self.tick <= 1.0:
            raise SpecError(f"tick is {self.tick} s; give the physics period, from 0.0001 to 1 s")
        if not isinstance(self.seed, int) or isinstance(self.seed, bool) or self.seed < 0:
            raise SpecError(f"seed is {self.seed!r}; give a whole number, 0 or above")
        if self.engine not in ("numpy", "numba", "auto"):
            engine(self.engine)

    def __getstate__(self) -> dict[str, Any]:
        """Leave out the cached scene. A copy, in this or another process, builds its own."""
        return {item.name: getattr(self, item.name) for item in fields(self)}

    @cached_property
    def tick_ns(self) -> int:
        """The physics period in nanoseconds."""
        return round(self.tick * 1e9)

    @cached_property
    def scene(self) -> Scene:
        """The world and the robots in the form that the engine needs, built once."""
        return build(self.world, self.robots, self.seed, self.engine)

    def movers_at(self, time_ns: int) -> list[tuple[float, float, float]]:
        """Return the world's movers at a simulated time, each as `(x, y, radius)` in metres."""
        return self.scene.movers_at(time_ns)

    @cached_property
    def _numbers(self) -> dict[str | None, int]:
        return {None: 0, **{robot.name: number for number, robot in enumerate(self.robots)}}

    def number_of(self, robot: str | None) -> int:
        """Return the index of a robot, 0 if `robot` is None. Raise a SpecError if no robot has this name."""
        try:
            return self._numbers[robot]
        except KeyError:
            names = ", ".join(spec.name for spec in self.robots)
            raise SpecError(f"there is no robot {robot!r}; the robots are: {names}") from None


@dataclass(frozen=True, slots=True)
class RobotState:
    """One robot at one instant.

    `pose` is the true pose in the frame `map`. `velocity`, in m/s and rad/s, is that of its wheels. They continue to
    turn while the robot slides along an obstacle. `command` is the last one received, at `command_ns`. `odometry` is
    the pose measured by its wheels in the frame `odom`, which begins at the start pose, and `covariance` the covariance
    of (x, y, theta), 3 x 3 row by row in m², m rad and rad². `collided` is true while an obstacle blocks it, and
    `collisions` counts its contacts. While its lidar is frozen, `held` is the state in which it froze.
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


@dataclass(frozen=True, slots=True)
class State:
    """The state of a run at one instant, `tick` physics ticks and `time_ns` nanoseconds after its start.

    `events` are those of the step that led to this state.
    """

    tick: int
    time_ns: int
    robots: tuple[RobotState, ...]
    events: tuple[Event, ...] = ()
