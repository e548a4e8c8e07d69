"""`simulator`: simulates the robot in the kernel, in real time, while other programs talk to it over ROS."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from autograder import layout
from autograder.notebook.notices import Notice
from autograder.ros import activate
from sim.grading import grading

if TYPE_CHECKING:
    from sim import Recording
    from sim.bridge import Bridge
    from sim.view import Picture

PERIOD = 0.05  # s of real time between two looks at the robot


class SimulatorSession:
    """What the robot did while it was simulated; the track is there once the block is over."""

    def __init__(self) -> None:
        self.recording: Recording | None = None

    @property
    def track(self) -> Picture | Notice:
        """The robot's track as a picture."""
        if self.recording is None:
            return Notice("The robot has not been simulated yet.")
        from sim.view import plot

        return plot(self.recording)


@contextmanager
def simulator(world: str = "empty_room", speed: float = 1.0) -> Iterator[SimulatorSession]:
    """Simulate a robot in a world while the block runs: /scan, /odom and /clock come from it, /cmd_vel moves it.

    Args:
        world: a name in `assets/worlds`.
        speed: simulated seconds in a second of real time.

    Raises:
        UsageError: there is no such world.
    """
    path = layout.world(world)
    session = SimulatorSession()
    if grading():
        yield session
        return
    activate()
    from sim.bridge import Bridge

    with Bridge(path, speed=speed) as bridge:
        stop = threading.Event()
        watcher = threading.Thread(target=_record, args=(bridge, session, stop), daemon=True)
        watcher.start()
        try:
            yield session
        finally:
            stop.set()
            watcher.join()


def _record(bridge: Bridge, session: SimulatorSession, stop: threading.Event) -> None:
    from sim import Recorder

    state = bridge.driver.state
    recorder = Recorder(bridge.simulation, state)
    running = True
    while running:
        running = not stop.wait(PERIOD)
        if bridge.driver.state.time_ns > state.time_ns:
            state = bridge.driver.state
            recorder.append(state)
    session.recording = recorder.recording()
