"""The drives through hidden worlds; each runs once, when a check first asks for it."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from statistics import fmean
from typing import Any

import numpy as np

from autograder.checking import ReceivedMessage, drive
from autograder.checks.ch02_nodes.hidden import world_generation
from autograder.checks.ch08_capstone.hidden.tracks import Floats, LidarFault, blocked_scan
from autograder.checks.ch08_capstone.support.contract import CONTROLLER, PARAMETERS
from autograder.checks.ch08_capstone.support.system import System
from sim import Pose, Recording, RobotSpec, Scan, Simulation, State, World, box

RADIUS = 0.18  # m: the robot's radius
ROOM_SECONDS, CORRIDOR_SECONDS, FAULTY_SECONDS = 20.0, 36.0, 14.0  # s: the lengths of the drives
SPEED = PARAMETERS[CONTROLLER]["forward_speed"].default
TURN_SPEED = PARAMETERS[CONTROLLER]["turn_speed"].default
STILL = 0.02  # m/s, rad/s: a slower robot counts as standing still
MIN_SPEED_SHARE = 0.1  # of the contract's speeds: a robot that is even slower gets no more time
DEAD = LidarFault("dead", 3.0, 7.0)
BLOCKED = LidarFault("blocked", 9.5, 11.5)


@dataclass(frozen=True)
class DriveResult:
    """A drive: its recording, its duration, its start in the harness's time, and its commands."""

    recording: Recording
    seconds: float
    start: float
    commands: tuple[ReceivedMessage, ...]


class Drives:
    """The drives of one submission, in worlds that are drawn from the seed."""

    def __init__(self, system: Callable[[], System], seed: int) -> None:
        self._system, self._seed = system, seed

    @cached_property
    def room(self) -> DriveResult:
        """Twenty seconds in a furnished room; a slower robot gets more time, so that it also reaches a wall."""
        draw = random.Random(f"{self._seed}:room")
        return self._drive_at_own_pace(world_generation.furnished_room(draw), ROOM_SECONDS, draw)

    @cached_property
    def corridor(self) -> DriveResult:
        """A short corridor with one bend, until the robot has passed the bend and driven on."""

        def has_arrived(state: State) -> bool:
            pose = state.robots[0].pose
            return bool(self._bend.share(np.array([pose.x]), np.array([pose.y])).max() >= 1.0)

        draw = random.Random(f"{self._seed}:corridor")
        return self._drive_at_own_pace(self._bend.world, CORRIDOR_SECONDS, draw, has_arrived)

    @cached_property
    def faulty_lidar(self) -> DriveResult:
        """A large empty hall. The lidar is dead for a while, and later it is blocked for a while."""
        draw = random.Random(f"{self._seed}:faulty")
        start = Pose(-5.0, draw.uniform(-0.5, 0.5), draw.uniform(-0.1, 0.1))
        hall = World.from_segments(box(13.0, 5.0).tolist(), name="an empty hall", starts=[start])
        return self._drive(hall, FAULTY_SECONDS, draw, alter_scan=_inject_faults)

    def share_of_corridor(self, recording: Recording) -> float:
        """Return the share of the way to the end of the corridor that the robot has driven, at most 1."""
        return float(self._bend.share(recording.poses[:, 0, 0], recording.poses[:, 0, 1]).max())

    @cached_property
    def _bend(self) -> Bend:
        return draw_bend(random.Random(f"{self._seed}:bend"))

    def _drive_at_own_pace(
        self,
        world: World,
        seconds: float,
        draw: random.Random,
        has_arrived: Callable[[State], bool] = lambda state: False,
    ) -> DriveResult:
        """Drive until the robot has arrived, for `seconds` at most.

        A robot that is slower than the contract's maximum speeds gets proportionally more time.
        """
        pace = Pace()

        def is_over(state: State) -> bool:
            pace.add(state)
            return has_arrived(state) or state.time_ns / 1e9 >= seconds / pace.share

        return self._drive(world, seconds / MIN_SPEED_SHARE, draw, until=is_over)

    def _drive(self, world: World, seconds: float, draw: random.Random, **options: Any) -> DriveResult:
        simulation = Simulation(world, (RobotSpec(radius=RADIUS),), seed=draw.randrange(2**31))
        system = self._system()
        start = system.seconds
        result = drive(system.harness, simulation, seconds, **options)
        return DriveResult(result.recording, system.seconds - start, start, tuple(system.messages(start).commands))


class Pace:
    """A robot's average speed while it drives or turns, as a share of the contract's speeds."""

    def __init__(self) -> None:
        self._speeds: list[float] = []
        self._rates: list[float] = []

    def add(self, state: State) -> None:
        """Add the speeds of one state of the drive."""
        velocity = state.robots[0].velocity
        for values, value in ((self._speeds, velocity.linear), (self._rates, abs(velocity.angular))):
            if value > STILL:
                values.append(value)

    @property
    def share(self) -> float:
        """The smaller of the shares of both speeds, from `MIN_SPEED_SHARE` to 1; a share without data counts as 1."""
        shares = (
            fmean(values) / maximum for values, maximum in ((self._speeds, SPEED), (self._rates, TURN_SPEED)) if values
        )
        return max(MIN_SPEED_SHARE, min(1.0, *shares, 1.0))


@dataclass(frozen=True)
class Bend:
    """A corridor that runs along +x for `first` metres, then to a side for `second` metres.

    `side` is 1 for left (+y), -1 for right.
    """

    first: float
    second: float
    side: float
    world: World

    def share(self, x: Floats, y: Floats) -> Floats:
        """Return the share of the way to the far end that a robot at (x, y), in metres, has driven."""
        start = self.world.starts[0]
        before_bend = np.clip(x - start.x, 0.0, self.first - start.x)
        beyond_bend = np.where(x > self.first - 0.9, np.clip(self.side * y, 0.0, self.second), 0.0)
        length = self.first - start.x + self.second - 1.5  # the robot turns back before the end
        share: Floats = np.minimum(1.0, (before_bend + beyond_bend) / length)
        return share


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


def _inject_faults(scan: Scan, seconds: float) -> Scan | None:
    if DEAD.covers(seconds):
        return None
    if BLOCKED.covers(seconds):
        return blocked_scan(scan)
    return scan
