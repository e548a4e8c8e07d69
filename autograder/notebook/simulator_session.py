"""`simulator`: simulates robots in a process of their own, in real time, while other programs talk to them over ROS."""

from __future__ import annotations

import shlex
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from autograder import layout
from autograder.notebook.driving import RADIUS
from autograder.notebook.notices import Notice
from autograder.notebook.terminal import running
from sim.grading import grading
from sim.recording import Recording, load_recording

if TYPE_CHECKING:
    from sim.view import Player

READY_SECONDS = 180.0  # real time: the first simulation on a machine compiles the engine, on a busy one for a minute


class SimulatorSession:
    """What the robots did while they were simulated; the track is there once the block is over."""

    def __init__(self) -> None:
        self.recording: Recording | None = None

    @property
    def track(self) -> Player | Notice:
        """The robots' tracks: the player, and a picture where nothing can play."""
        if self.recording is None:
            return Notice("The robot has not been simulated yet.")
        from sim.view import Player

        return Player(self.recording)


@contextmanager
def simulator(
    world: str = "empty_room", speed: float = 1.0, robots: Sequence[str] = ("",)
) -> Iterator[SimulatorSession]:
    """Simulate robots in a world while the block runs: /scan, /odom and /clock come from it, /cmd_vel moves a robot.

    The simulator is a program of its own, as on a real robot. Its log is printed in the cell. The robots have the size
    of the one that `drive` has.

    Args:
        world: its name.
        speed: simulated seconds in a second of real time.
        robots: the namespaces of the robots, one robot each; "" is a robot without a namespace.

    Raises:
        UsageError: there is no such world.
    """
    path = layout.world(world)
    session = SimulatorSession()
    if grading():
        yield session
        return
    with tempfile.TemporaryDirectory() as folder:
        recording = Path(folder) / "run.npz"
        parameters = {"world": path, "speed": float(speed), "robots": list(robots), "radius": RADIUS}
        parameters["recording"] = recording
        settings = [word for name, value in parameters.items() for word in ("-p", f"{name}:={value}")]
        node = [sys.executable, "-m", "sim.bridge", "--ros-args", *settings]
        command = shlex.join([sys.executable, "-m", "autograder", "ros", *node])
        with running(command, until="robot(s)", seconds=READY_SECONDS, workspace=folder):
            yield session
        session.recording = load_recording(recording) if recording.exists() else None
