"""The drives through hidden worlds: each is made when a check first asks for it, once."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from autograder.lab import Stamped, drive
from autograder.lab.drive import Tamper
from autograder.suites.ch02_nodes import terrain
from autograder.suites.ch08_capstone.tracks import Trouble, blocked
from autograder.visible.ch08_capstone.system import System
from sim import Pose, Recording, RobotSpec, Scan, Simulation, World, box

RADIUS = 0.18  # m
ROOM_SECONDS, CORRIDOR_SECONDS, FAULTY_SECONDS = 30.0, 36.0, 20.0
DARK = Trouble("dead", 4.0, 8.0)
BLOCKED = Trouble("blocked", 12.0, 15.0)


@dataclass(frozen=True)
class Driven:
    """A drive: the whole run, how long it was, and the commands with the lab's time at which it began."""

    recording: Recording
    seconds: float
    began: float
    commands: tuple[Stamped, ...]


class Drives:
    """The drives of one submission, in worlds that are drawn from the seed."""

    def __init__(self, system: Callable[[], System], seed: int) -> None:
        self._system, self._seed = system, seed

    @cached_property
    def room(self) -> Driven:
        """Half a minute in a furnished room."""
        draw = random.Random(f"{self._seed}:room")
        return self._drive(terrain.furnished_room(draw), ROOM_SECONDS, draw)

    @cached_property
    def corridor(self) -> Driven:
        """A short corridor with one bend to the left or to the right."""
        draw = random.Random(f"{self._seed}:corridor")
        return self._drive(self._bend.world, CORRIDOR_SECONDS, draw)

    @cached_property
    def faulty(self) -> Driven:
        """A large empty hall, with a lidar that dies and comes back, is blocked and comes free."""
        draw = random.Random(f"{self._seed}:faulty")
        start = Pose(-5.0, draw.uniform(-0.5, 0.5), draw.uniform(-0.1, 0.1))
        hall = World.from_segments(box(13.0, 5.0).tolist(), name="an empty hall", starts=[start])
        return self._drive(hall, FAULTY_SECONDS, draw, _tamper)

    def share_of_corridor(self, recording: Recording) -> float:
        """Return how much of the way to the end of the corridor the robot has made, at most 1."""
        return self._bend.share(recording)

    @cached_property
    def _bend(self) -> Bend:
        return draw_bend(random.Random(f"{self._seed}:bend"))

    def _drive(self, world: World, seconds: float, draw: random.Random, tamper: Tamper | None = None) -> Driven:
        simulation = Simulation(world, (RobotSpec(radius=RADIUS),), seed=draw.randrange(2**31))
        system = self._system()
        began = system.seconds
        done = drive(system.lab, simulation, seconds, tamper=tamper)
        return Driven(done.recording, seconds, began, tuple(system.said(began).commands))


@dataclass(frozen=True)
class Bend:
    """A corridor along +x for `first` metres, then to a side for `second` metres.

    `side` is 1 for left (+y), -1 for right.
    """

    first: float
    second: float
    side: float
    world: World

    def share(self, recording: Recording) -> float:
        """Return the greatest share of the way that the robot has made: to the bend, and on towards the far end."""
        start = recording.simulation.world.starts[0]
        x, y = recording.poses[:, 0, 0], self.side * recording.poses[:, 0, 1]
        along = np.clip(x - start.x, 0.0, self.first - start.x)
        up = np.where(x > self.first - 0.9, np.clip(y, 0.0, self.second), 0.0)
        enough = self.first - start.x + self.second - 1.5  # it turns round before the end
        return float(min(1.0, ((along + up) / enough).max()))


def draw_bend(draw: random.Random) -> Bend:
    """Draw a corridor with one bend."""
    width, first, second = draw.uniform(1.8, 2.2), draw.uniform(3.2, 4.0), draw.uniform(3.2, 4.0)
    side, half = draw.choice((1.0, -1.0)), width / 2
    corners = [
        (-half, -half),
        (first + half, -half),
        (first + half, second + half),
        (first - half, second + half),
        (first - half, half),
        (-half, half),
    ]
    corners = [(x, side * y) for x, y in corners]
    walls = [[*a, *b] for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)]
    names = ["the outer wall", "the outer wall", "the far end", "the inner wall", "the inner wall", "the near end"]
    start = Pose(draw.uniform(0.0, 0.3), draw.uniform(-0.2, 0.2), draw.uniform(-0.2, 0.2))
    world = World.from_segments(walls, name="a corridor with a bend", starts=[start], segment_names=names)
    return Bend(first, second, side, world)


def _tamper(scan: Scan, seconds: float) -> Scan | None:
    if DARK.covers(seconds):
        return None
    if BLOCKED.covers(seconds):
        return blocked(scan)
    return scan
