"""What a run is made of, and its state at one instant: frozen data, with no globals and no hidden clock."""

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
    """Something that happened, `what` in words, at the point (`x`, `y`) of the frame `map`.

    `kind` is "collision" (with the `speed` in m/s at which the obstacle was met) or "watchdog".
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
    """What a run is made of: a world, robots, a seed. Nothing in it ever changes.

    `tick` is the physics period in seconds; `engine` is who computes: "numpy", "numba" (the extra `fast`) or
    "auto" (numba where it is installed). All give the same states and the same scans, bit for bit.

    Raises SpecError where names repeat or values make no sense.
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
            raise SpecError(f"two robots have one name: {', '.join(names)}; give each its own")
        if not 1e-4 <= self.tick <= 1.0:
            raise SpecError(f"tick is {self.tick} s; give the physics period, from 0.0001 to 1 s")
        if not isinstance(self.seed, int) or isinstance(self.seed, bool) or self.seed < 0:
            raise SpecError(f"seed is {self.seed!r}; give a whole number, 0 or above")
        if self.engine not in ("numpy", "numba", "auto"):
            engine(self.engine)

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what was laid out for the engine: a copy, here or in another process, lays it out again."""
        return {item.name: getattr(self, item.name) for item in fields(self)}

    @cached_property
    def tick_ns(self) -> int:
        """The physics period in nanoseconds."""
        return round(self.tick * 1e9)

    @cached_property
    def scene(self) -> Scene:
        """The world and the robots as the engine wants them, laid out once."""
        return build(self.world, self.robots, self.seed, self.engine)

    def movers_at(self, time_ns: int) -> list[tuple[float, float, float]]:
        """Return where the world's movers are at a simulated time: `(x, y, radius)` each, in metres."""
        return self.scene.movers_at(time_ns)

    @cached_property
    def _numbers(self) -> dict[str | None, int]:
        return {None: 0, **{robot.name: number for number, robot in enumerate(self.robots)}}

    def number_of(self, robot: str | None) -> int:
        """Return the index of a robot, the first for None. Raises SpecError for a name that no robot has."""
        try:
            return self._numbers[robot]
        except KeyError:
            names = ", ".join(spec.name for spec in self.robots)
            raise SpecError(f"there is no robot {robot!r}; the robots are: {names}") from None


@dataclass(frozen=True, slots=True)
class RobotState:
    """One robot at one instant.

    `pose` is the truth in the frame `map`; `velocity` what its wheels do now, in m/s and rad/s (they go on turning
    while it slides along something); `command` the last one received, at `command_ns`; `odometry` the pose by its
    wheels in the frame `odom` (which starts at the start pose), with `covariance` over (x, y, theta), 3 x 3 row by
    row in m², m rad and rad². `collided` is true while something blocks it; `collisions` counts the contacts so far.
    `held` is the state in which a frozen lidar froze.
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
    """The whole of a run at one instant: `tick` physics ticks and `time_ns` nanoseconds after its start.

    `events` are those of the step that led here.
    """

    tick: int
    time_ns: int
    robots: tuple[RobotState, ...]
    events: tuple[Event, ...] = ()
