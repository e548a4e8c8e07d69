"""The run of a live view of a ROS bridge: the view shows the node's states, and its buttons control the node."""

from __future__ import annotations

import bisect
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sim.pose import Command
from sim.recording import Recorder, Recording
from sim.simulation import Event
from sim.view.session import MAX_NS, Frame, collisions_in, track_points

if TYPE_CHECKING:
    from sim.bridge.background import Bridge


class Watch:
    """The frames of a running bridge. Robots are driven over ROS, or by the pad."""

    paced = False  # the node's parameter `speed` determines the speed
    can_be_released = True

    def __init__(self, bridge: Bridge) -> None:
        self.simulation = bridge.simulation
        self._bridge = bridge
        self._manual_command: Command | None = None
        self._is_paused = False
        self._clear()

    @property
    def end_ns(self) -> int:
        """The time of the last frame, in nanoseconds of simulated time."""
        return self._times[-1]

    @property
    def growing(self) -> bool:
        """Whether the bridge still runs."""
        return self._bridge.running and self.end_ns < MAX_NS

    def at(self, time_ns: int) -> Frame:
        """Return the last frame that is not later than `time_ns`."""
        return self._frames[max(0, bisect.bisect_right(self._times, time_ns) - 1)]

    def tracks(self, time_ns: int) -> NDArray[np.float64]:
        """Return the tracks of the robots up to `time_ns`, (K, robots, 2) in metres, with at least one position."""
        # The bridge may have run before the first frame.
        return track_points(self._frames, max(1, bisect.bisect_right(self._times, time_ns)))

    def collisions(self, time_ns: int) -> list[Event]:
        """Return the collisions up to `time_ns` in the frames. Those between two frames are missing."""
        return [event for event in self._collisions if event.time_ns <= time_ns]

    def advance(self, until_ns: int) -> int:
        """Read a frame from the bridge; return its time, which is the instant to show.

        A bridge that the view has paused is stepped until `until_ns`.
        """
        if self._is_paused and until_ns > self.end_ns:
            self._bridge.step((until_ns - self.end_ns) / 1e9)
        if self._manual_command is not None:
            self._bridge.driver.command(self.simulation.robots[0].name, self._manual_command)
        self._add_frame()
        return self.end_ns

    def set_paused(self, paused: bool) -> None:
        """Pause the bridge, or resume it."""
        self._is_paused = paused
        if self._bridge.running:
            (self._bridge.pause if paused else self._bridge.resume)()
            self._add_frame()

    def reset(self) -> None:
        """Return the bridge to its start."""
        self._bridge.reset()
        self._clear()

    def drive(self, command: Command | None) -> None:
        """Repeat a command to the first robot, like messages on cmd_vel. None ends the repetition."""
        self._manual_command = command

    def recording(self) -> Recording:
        """Return a recording of the frames, without commands."""
        return self._recorder.recording()

    def _add_frame(self) -> None:
        frame = self._read_frame()
        if frame.state.time_ns < self.end_ns:  # the bridge has been reset
            self._clear()
        elif frame.state.time_ns > self.end_ns:
            self._frames.append(frame)
            self._times.append(frame.state.time_ns)
            self._recorder.append(frame.state)
            self._collisions += collisions_in(frame.state)

    def _read_frame(self) -> Frame:
        driver = self._bridge.driver
        newest_scans = dict(driver.newest_scans)
        return Frame(driver.state, tuple(newest_scans.get(spec.name) for spec in self.simulation.robots))

    def _clear(self) -> None:
        frame = self._read_frame()
        self._frames = [frame]
        self._collisions = collisions_in(frame.state)
        self._times = [frame.state.time_ns]
        self._recorder = Recorder(self.simulation, frame.state)
