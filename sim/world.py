"""A world: named walls and pillars, start poses, goals and moving obstacles, as plain frozen data."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sim.exceptions import WorldError
from sim.pose import Pose

Floats = NDArray[np.float64]
Bounds = tuple[float, float, float, float]

MAX_METRES = 100_000.0
# A smaller coordinate is treated as zero, because products of such numbers would underflow.
MIN_METRES = 1e-60


@dataclass(frozen=True, slots=True)
class Goal:
    """A disc to reach: centre and `radius` in metres, frame `map`."""

    x: float
    y: float
    radius: float = 0.25
    name: str = "goal"

    def __post_init__(self) -> None:
        if not (_is_within_limits(self.x) and _is_within_limits(self.y) and 0.0 < self.radius <= MAX_METRES):
            raise WorldError(
                f"a goal at ({self.x}, {self.y}) with radius {self.radius} is invalid",
                "Give metres, and a radius above 0",
            )


@dataclass(frozen=True, slots=True)
class Mover:
    """A disc that moves along `path` (points in metres) for ever, back and forth or in a loop.

    `speed` is in m/s, and `pause` is the waiting time at each point in seconds. `phase` is the share of the cycle that
    has passed at time 0. If it is None, it is drawn from the run's seed, so that each seed has its own schedule.
    """

    path: tuple[tuple[float, float], ...]
    radius: float = 0.2
    speed: float = 0.3
    pause: float = 0.0
    loop: bool = False
    phase: float | None = None
    name: str = "mover"

    def __post_init__(self) -> None:
        object.__setattr__(self, "path", tuple((float(x), float(y)) for x, y in self.path))
        conditions = (
            (
                "path",
                self.path and all(_is_within_limits(x) and _is_within_limits(y) for x, y in self.path),
                "one point or more, in metres",
            ),
            ("radius", 0.0 < self.radius <= MAX_METRES, "metres, above 0"),
            ("speed", 0.0 < self.speed <= 100.0, "m/s, above 0 and at most 100"),
            ("pause", 0.0 <= self.pause <= 1e6, "seconds, 0 or above"),
            ("phase", self.phase is None or 0.0 <= self.phase <= 1.0, "a share of the cycle, from 0 to 1"),
        )
        for label, is_valid, remedy in conditions:
            if not is_valid:
                value = getattr(self, label)
                raise WorldError(f"the {label} of the mover {self.name!r} is {value!r}", f"Give {remedy}")


@dataclass(frozen=True, eq=False)
class World:
    """The surroundings of a robot, in the frame `map`.

    `segments` is (N, 4) float64, one `[x1, y1, x2, y2]` for each wall, and `circles` (M, 3) float64, one `[x, y, r]`
    for each pillar, all in metres and read-only. `segment_names` and `circle_names` contain a possibly empty name for
    each. `bounds` is `(xmin, ymin, xmax, ymax)`, by default those of everything in the world.
    """

    name: str = "world"
    segments: Floats = field(default_factory=lambda: np.empty((0, 4)))
    circles: Floats = field(default_factory=lambda: np.empty((0, 3)))
    starts: tuple[Pose, ...] = (Pose(),)
    goals: tuple[Goal, ...] = ()
    movers: tuple[Mover, ...] = ()
    segment_names: tuple[str, ...] = ()
    circle_names: tuple[str, ...] = ()
    bounds: Bounds = (0.0, 0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        segments = _table(self.segments, 4, "segments")
        circles = _table(self.circles, 3, "circles")
        if (circles[:, 2] <= 0).any():
            raise WorldError("a circle's radius is not above zero", "Give every circle a radius in metres")
        set_field = object.__setattr__
        set_field(self, "segments", segments)
        set_field(self, "circles", circles)
        set_field(self, "starts", tuple(self.starts) or (Pose(),))
        if not all(
            _is_within_limits(pose.x) and _is_within_limits(pose.y) and math.isfinite(pose.theta)
            for pose in self.starts
        ):
            raise WorldError("a start pose is not within the world", "Give finite numbers in metres and radians")
        set_field(self, "goals", tuple(self.goals))
        set_field(self, "movers", tuple(self.movers))
        set_field(self, "segment_names", _names(self.segment_names, len(segments), "segment_names"))
        set_field(self, "circle_names", _names(self.circle_names, len(circles), "circle_names"))
        if tuple(self.bounds) == (0.0, 0.0, 0.0, 0.0):
            set_field(self, "bounds", _bounds(self))

    @classmethod
    def from_segments(
        cls,
        segments: ArrayLike,
        *,
        circles: ArrayLike = (),
        name: str = "world",
        starts: Iterable[Pose] = (Pose(),),
        goals: Iterable[Goal] = (),
        movers: Iterable[Mover] = (),
        segment_names: Sequence[str] = (),
        circle_names: Sequence[str] = (),
    ) -> World:
        """Build a world in code.

        Args:
            segments: walls (N, 4), rows `[x1, y1, x2, y2]` in metres.
            circles: solid circles (M, 3), rows `[x, y, r]` in metres.
            name: the world's name.
            starts: the start poses, in the robots' order.
            goals: places to reach.
            movers: moving obstacles.
            segment_names: the names of the walls, in order. Walls without a name are numbered.
            circle_names: the names of the circles, in order. Circles without a name are numbered.
        """
        return cls(
            name=name,
            segments=np.asarray(segments, dtype=np.float64).reshape(-1, 4),
            circles=np.asarray(circles, dtype=np.float64).reshape(-1, 3),
            starts=tuple(starts),
            goals=tuple(goals),
            movers=tuple(movers),
            segment_names=tuple(segment_names),
            circle_names=tuple(circle_names),
        )


def box(width: float, height: float, *, x: float = 0.0, y: float = 0.0) -> Floats:
    """Return the four walls (4, 4) of a room, in the order of `BOX_NAMES`: south, east, north, west.

    Args:
        width: the size along x, in metres.
        height: the size along y, in metres.
        x: the x of the room's centre, in metres.
        y: the y of the room's centre, in metres.
    """
    west, east, south, north = x - width / 2, x + width / 2, y - height / 2, y + height / 2
    return np.array(
        [
            [west, south, east, south],
            [east, south, east, north],
            [east, north, west, north],
            [west, north, west, south],
        ]
    )


BOX_NAMES = ("south wall", "east wall", "north wall", "west wall")


def _is_within_limits(value: float) -> bool:
    return -MAX_METRES <= value <= MAX_METRES


def _table(rows: ArrayLike, width: int, label: str) -> Floats:
    try:
        table = np.array(rows, dtype=np.float64, order="C")
    except (TypeError, ValueError) as error:
        raise WorldError(f"{label} are not numbers ({error})", f"Give rows of {width} numbers") from None
    if table.size == 0:
        table = np.empty((0, width))
    if table.ndim != 2 or table.shape[1] != width:
        raise WorldError(f"{label} have the shape {table.shape}", f"Give rows of {width} numbers")
    if not (np.abs(table) <= MAX_METRES).all():
        raise WorldError(
            f"{label} contain a number that is not within {MAX_METRES:g} m", "Give finite numbers in metres"
        )
    table[np.abs(table) < MIN_METRES] = 0.0
    table.flags.writeable = False
    return table


def _names(names: Sequence[str], count: int, label: str) -> tuple[str, ...]:
    if not names:
        return ("",) * count
    if len(names) != count:
        raise WorldError(f"{label} contains {len(names)} names for {count}", "Give one name for each, or none at all")
    return tuple(names)


def _bounds(world: World) -> Bounds:
    xs = [world.segments[:, 0::2].ravel(), world.circles[:, 0] - world.circles[:, 2]]
    ys = [world.segments[:, 1::2].ravel(), world.circles[:, 1] - world.circles[:, 2]]
    xs += [world.circles[:, 0] + world.circles[:, 2], np.array([pose.x for pose in world.starts])]
    ys += [world.circles[:, 1] + world.circles[:, 2], np.array([pose.y for pose in world.starts])]
    xs.append(np.array([point[0] for mover in world.movers for point in mover.path]))
    ys.append(np.array([point[1] for mover in world.movers for point in mover.path]))
    x, y = np.concatenate(xs), np.concatenate(ys)
    bounds = (float(x.min()), float(y.min()), float(x.max()), float(y.max()))
    return bounds if all(map(math.isfinite, bounds)) else (0.0, 0.0, 0.0, 0.0)
