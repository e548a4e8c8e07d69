"""The run of a live view: it is simulated while it is shown, and its past can be shown again.

It uses no widget and no clock: the caller of `advance` determines the simulated time, so tests are fast.
"""

from __future__ import annotations

import bisect
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from sim.lidar import Scan
from sim.pose import Command, Pose
from sim.rates import due
from sim.recording import Recorder, Recording
from sim.simulation import Event, Simulation, State, observe, start, step

Controller = Callable[[Scan], Command | None]
"""A student's callback, which is called with each new scan and returns the next command, or None to keep the last."""


MAX_NS = 1_800_000_000_000
"""The maximum duration of a live run: half an hour of simulated time."""

TRAIL = 1500
"""The approximate maximum number of points of a robot's track in a frame."""


@dataclass(frozen=True)
class Frame:
    """One instant: a state, and the newest scan of each robot with the robot's pose at that scan."""

    state: State
    scans: tuple[tuple[Scan, Pose] | None, ...]


class Source(Protocol):
    """The interface of the runs that a live view can show. Times are in nanoseconds of simulated time."""

    paced: bool
    """Whether the view determines the speed of the run."""

    @property
    def simulation(self) -> Simulation:
        """The parameters of the run."""

    @property
    def end_ns(self) -> int:
        """The time of the last state."""

    @property
    def growing(self) -> bool:
        """Whether the run can continue."""

    @property
    def can_be_released(self) -> bool:
        """Whether a callback or a node drives when the pad does not."""

    def at(self, time_ns: int) -> Frame:
        """Return the last frame that is not later than `time_ns` (the first one if all are later)."""

    def tracks(self, time_ns: int) -> NDArray[np.float64]:
        """Return the tracks of the robots up to `time_ns`, (K, robots, 2) in metres."""

    def collisions(self, time_ns: int) -> list[Event]:
        """Return the collisions up to `time_ns`, in the order of their times."""

    def advance(self, until_ns: int) -> int:
        """Run until `until_ns`; return the instant to show."""

    def set_paused(self, paused: bool) -> None:
        """React when the view is paused or continued."""

    def reset(self) -> None:
        """Return to the start, and drop the recorded states."""

    def drive(self, command: Command | None) -> None:
        """Drive the first robot manually. None returns control to the callback or node."""

    def recording(self) -> Recording:
        """Return the recording of the run, which can be plotted, saved or replayed."""


class Session:
    """A run in progress. `frames` contains a frame for the start and for each physics tick."""

    paced = True

    def __init__(self, simulation: Simulation, controller: Controller | None = None) -> None:
        self.simulation = simulation
        self.controller = controller
        self.reset()

    def reset(self) -> None:
        """Return to the start, and drop the recorded states."""
        state = start(self.simulation)
        self._recorder = Recorder(self.simulation, state)
        self._times: list[int] = []
        self._collisions: list[Event] = []
        self.frames: list[Frame] = []
        self.automatic = self.controller is not None
        self.command = Command()
        self._append(state, (None,) * len(self.simulation.robots))

    @property
    def end_ns(self) -> int:
        """The time of the last state, in nanoseconds of simulated time."""
        return self._times[-1]

    @property
    def growing(self) -> bool:
        """Whether the run can continue. Its length is limited, so that a forgotten view does not fill the memory."""
        return self.end_ns < MAX_NS

    @property
    def can_be_released(self) -> bool:
        """Whether there is a controller."""
        return self.controller is not None

    def at(self, time_ns: int) -> Frame:
        """Return the last frame that is not later than `time_ns` (the first one if all are later)."""
        return self.frames[max(0, bisect.bisect_right(self._times, time_ns) - 1)]

    def tracks(self, time_ns: int) -> NDArray[np.float64]:
        """Return the tracks of the robots up to `time_ns`, (K, robots, 2) in metres."""
        return track_points(self.frames, bisect.bisect_right(self._times, time_ns))

    def collisions(self, time_ns: int) -> list[Event]:
        """Return the collisions up to `time_ns`, in the order of their times."""
        return [event for event in self._collisions if event.time_ns <= time_ns]

    def drive(self, command: Command | None) -> None:
        """Drive the first robot manually from the next tick on. None returns control to the controller."""
        self.automatic = command is None
        self.command = self.command if command is None else command

    def set_paused(self, paused: bool) -> None:
        """Do nothing, because this run advances only in `advance`."""

    def advance(self, until_ns: int) -> int:
        """Step the run until `until_ns`; return the instant to show. Exceptions of the controller are passed on."""
        tick_ns = self.simulation.tick_ns
        while self.growing and self._times[-1] + tick_ns <= until_ns:
            frame = self.frames[-1]
            if self.automatic and self.controller is not None and _is_new(frame):
                newest = frame.scans[0]
                next_command = self.controller(newest[0]) if newest is not None else None
                if next_command is not None and not isinstance(next_command, Command):
                    raise TypeError(f"the callback must return a Command or None, not {type(next_command).__name__}")
                self.command = self.command if next_command is None else next_command
            state = step(self.simulation, frame.state, {self.simulation.robots[0].name: self.command})
            self._append(state, frame.scans)
        return until_ns

    def recording(self) -> Recording:
        """Return the recording of the run, which can be plotted, saved or replayed."""
        return self._recorder.recording()

    def _append(self, state: State, scans: tuple[tuple[Scan, Pose] | None, ...]) -> None:
        is_first = not self._times
        if not is_first:
            self._recorder.append(state, {self.simulation.robots[0].name: self.command})
        newest_scans = list(scans)
        for index, spec in enumerate(self.simulation.robots):
            if spec.lidar is not None and (is_first or due(self._times[-1], state.time_ns, spec.lidar.rate)):
                scan = observe(self.simulation, state, spec.name)
                self._recorder.scan(scan, spec.name)
                if scan is not None:
                    newest_scans[index] = (scan, state.robots[index].pose)
        self.frames.append(Frame(state, tuple(newest_scans)))
        self._times.append(state.time_ns)
        self._collisions += collisions_in(state)


def track_points(frames: Sequence[Frame], count: int) -> NDArray[np.float64]:
    """Return the robots' positions in some of the first `count` frames, (K, robots, 2) in metres."""
    robots = (frame.state.robots for frame in frames[: count : 1 + count // TRAIL])
    return np.array([[(robot.pose.x, robot.pose.y) for robot in row] for row in robots], dtype=np.float64)


def collisions_in(state: State) -> list[Event]:
    """Return the collisions of the step that led to a state."""
    return [event for event in state.events if event.kind == "collision"]


def _is_new(frame: Frame) -> bool:
    newest = frame.scans[0]
    return newest is not None and newest[0].stamp_ns == frame.state.time_ns
