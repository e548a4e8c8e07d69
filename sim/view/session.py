"""What a live view plays: a run that grows as it is watched, whose past can be visited.

No widget and no clock: `advance` is told how much simulated time to add, so a test plays a minute in a moment.
"""

from __future__ import annotations

import bisect
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from sim.lidar import Scan
from sim.pose import Command, Pose
from sim.rates import due
from sim.recording import Recorder, Recording
from sim.simulation import Simulation, State, observe, start, step

Controller = Callable[[Scan], Command | None]
"""A student's callback: it gets each new scan and returns the next command; None keeps the last one."""


LONGEST_NS = 1_800_000_000_000
"""A live run ends after half an hour of simulated time."""

TRAIL = 1500
"""At most about so many points of a track are drawn in a frame."""


@dataclass(frozen=True)
class Frame:
    """One instant to be shown: a state, and the newest scan of each robot with the pose it was taken from."""

    state: State
    scans: tuple[tuple[Scan, Pose] | None, ...]


class Source(Protocol):
    """What a live view can play. Times are in nanoseconds of simulated time."""

    paced: bool
    """Whether the view's speed is the run's speed."""

    @property
    def simulation(self) -> Simulation:
        """What the run is made of."""

    @property
    def end_ns(self) -> int:
        """How far the run has got."""

    @property
    def growing(self) -> bool:
        """Whether there is more to come."""

    @property
    def can_be_released(self) -> bool:
        """Whether somebody else drives when the pad does not."""

    def at(self, time_ns: int) -> Frame:
        """Return the last frame that is not later than `time_ns` (the first one, if all are)."""

    def trail(self, time_ns: int) -> NDArray[np.float64]:
        """Return the track of the first robot up to `time_ns`, (K, 2) in metres."""

    def advance(self, until_ns: int) -> int:
        """Run up to `until_ns` and return the instant to be shown."""

    def hold(self, paused: bool) -> None:
        """Be told that the view has been paused, or plays again."""

    def reset(self) -> None:
        """Go back to the start and forget the past."""

    def drive(self, command: Command | None) -> None:
        """Drive the first robot by hand; None gives it back to whoever drove it before."""

    def recording(self) -> Recording:
        """Return the run so far as a recording, to be plotted, saved or replayed."""


class Session:
    """A run in progress. `frames` is its past, one a physics tick, never empty."""

    paced = True

    def __init__(self, simulation: Simulation, controller: Controller | None = None) -> None:
        self.simulation = simulation
        self.controller = controller
        self.reset()

    def reset(self) -> None:
        """Go back to the start and forget the past."""
        state = start(self.simulation)
        self._recorder = Recorder(self.simulation, state)
        self._times: list[int] = []
        self._track: list[tuple[float, float]] = []
        self.frames: list[Frame] = []
        self.automatic = self.controller is not None
        self.command = Command()
        self._append(state, (None,) * len(self.simulation.robots))

    @property
    def end_ns(self) -> int:
        """How far the run has got, in nanoseconds of simulated time."""
        return self._times[-1]

    @property
    def growing(self) -> bool:
        """Whether `advance` can add to the run; a forgotten view must not fill the memory."""
        return self.end_ns < LONGEST_NS

    @property
    def can_be_released(self) -> bool:
        """Whether there is a controller."""
        return self.controller is not None

    def at(self, time_ns: int) -> Frame:
        """Return the last frame that is not later than `time_ns` (the first one, if all are)."""
        return self.frames[max(0, bisect.bisect_right(self._times, time_ns) - 1)]

    def trail(self, time_ns: int) -> NDArray[np.float64]:
        """Return the track of the first robot up to `time_ns`, (K, 2) in metres."""
        count = bisect.bisect_right(self._times, time_ns)
        return np.array(self._track[: count : 1 + count // TRAIL], dtype=np.float64).reshape(-1, 2)

    def drive(self, command: Command | None) -> None:
        """Take the first robot over by hand, from the next tick on; None gives it back to the controller."""
        self.automatic = command is None
        self.command = self.command if command is None else command

    def hold(self, paused: bool) -> None:
        """Do nothing: this run goes on only when it is told to."""

    def advance(self, until_ns: int) -> int:
        """Step the run until it has reached `until_ns`; what the controller raises is raised here.

        Returns the instant to be shown.
        """
        tick_ns = self.simulation.tick_ns
        while self.growing and self._times[-1] + tick_ns <= until_ns:
            frame = self.frames[-1]
            if self.automatic and self.controller is not None and _is_new(frame):
                newest = frame.scans[0]
                wanted = self.controller(newest[0]) if newest is not None else None
                if wanted is not None and not isinstance(wanted, Command):
                    raise TypeError(f"the callback must return a Command or None, not {type(wanted).__name__}")
                self.command = self.command if wanted is None else wanted
            state = step(self.simulation, frame.state, {self.simulation.robots[0].name: self.command})
            self._append(state, frame.scans)
        return until_ns

    def recording(self) -> Recording:
        """Return the run so far as a recording, to be plotted, saved or replayed."""
        return self._recorder.recording()

    def _append(self, state: State, scans: tuple[tuple[Scan, Pose] | None, ...]) -> None:
        first = not self._times
        if not first:
            self._recorder.append(state, {self.simulation.robots[0].name: self.command})
        fresh = list(scans)
        for index, spec in enumerate(self.simulation.robots):
            if spec.lidar is not None and (first or due(self._times[-1], state.time_ns, spec.lidar.rate)):
                scan = observe(self.simulation, state, spec.name)
                self._recorder.scan(scan, spec.name)
                if scan is not None:
                    fresh[index] = (scan, state.robots[index].pose)
        self.frames.append(Frame(state, tuple(fresh)))
        self._times.append(state.time_ns)
        self._track.append((state.robots[0].pose.x, state.robots[0].pose.y))


def _is_new(frame: Frame) -> bool:
    newest = frame.scans[0]
    return newest is not None and newest[0].stamp_ns == frame.state.time_ns
