"""What a live view plays when a ROS bridge runs the robot: the view looks on, and its buttons reach the node."""

from __future__ import annotations

import bisect
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from sim.pose import Command
from sim.recording import Recorder, Recording
from sim.view.session import LONGEST_NS, TRAIL, Frame

if TYPE_CHECKING:
    from sim.bridge.background import Bridge


class Watch:
    """The frames that the view has seen of a running bridge. Robots are driven over ROS, or by the pad."""

    paced = False  # the node's parameter `speed` is the pace
    can_be_released = True

    def __init__(self, bridge: Bridge) -> None:
        self.simulation = bridge.simulation
        self._bridge = bridge
        self._held: Command | None = None
        self._holding = False
        self._forget()

    @property
    def end_ns(self) -> int:
        """The newest instant seen, in nanoseconds of simulated time."""
        return self._times[-1]

    @property
    def growing(self) -> bool:
        """Whether the bridge still runs."""
        return self._bridge.running and self.end_ns < LONGEST_NS

    def at(self, time_ns: int) -> Frame:
        """Return the last frame seen that is not later than `time_ns`."""
        return self._frames[max(0, bisect.bisect_right(self._times, time_ns) - 1)]

    def trail(self, time_ns: int) -> NDArray[np.float64]:
        """Return the track of the first robot up to `time_ns`, (K, 2) in metres; its first place at least."""
        count = max(1, bisect.bisect_right(self._times, time_ns))  # the bridge may have run before it was looked at
        places = [frame.state.robots[0].pose for frame in self._frames[: count : 1 + count // TRAIL]]
        return np.array([(pose.x, pose.y) for pose in places])

    def advance(self, until_ns: int) -> int:
        """Look at the bridge once and return the instant to be shown: its newest.

        A bridge that the view itself has paused is stepped up to `until_ns`.
        """
        if self._holding and until_ns > self.end_ns:
            self._bridge.step((until_ns - self.end_ns) / 1e9)
        if self._held is not None:
            self._bridge.driver.command(self.simulation.robots[0].name, self._held)
        self._see()
        return self.end_ns

    def hold(self, paused: bool) -> None:
        """Let the bridge's time stand still, or go on."""
        self._holding = paused
        if self._bridge.running:
            (self._bridge.pause if paused else self._bridge.resume)()
            self._see()

    def reset(self) -> None:
        """Send the bridge back to its start."""
        self._bridge.reset()
        self._forget()

    def drive(self, command: Command | None) -> None:
        """Give the first robot a command, as a message on cmd_vel would, again and again; None lets go of it."""
        self._held = command

    def recording(self) -> Recording:
        """Return what the view has seen as a recording; commands are not in it."""
        return self._recorder.recording()

    def _see(self) -> None:
        frame = self._look()
        if frame.state.time_ns < self.end_ns:  # somebody has reset it
            self._forget()
        elif frame.state.time_ns > self.end_ns:
            self._frames.append(frame)
            self._times.append(frame.state.time_ns)
            self._recorder.append(frame.state)

    def _look(self) -> Frame:
        driver = self._bridge.driver
        newest = dict(driver.newest)
        return Frame(driver.state, tuple(newest.get(spec.name) for spec in self.simulation.robots))

    def _forget(self) -> None:
        frame = self._look()
        self._frames = [frame]
        self._times = [frame.state.time_ns]
        self._recorder = Recorder(self.simulation, frame.state)
