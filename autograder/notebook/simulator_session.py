"""`simulator` simulates robots in a separate process, in real time. Other programs communicate with them over ROS."""

from __future__ import annotations

import shlex
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from autograder import course_paths
from autograder.notebook.driving import RADIUS
from autograder.notebook.notices import Notice
from autograder.notebook.terminal import running
from sim.grading import grading
from sim.recording import Recording, load_recording

if TYPE_CHECKING:
    from sim.view import Player

# How long to wait for the simulator, in real time. The first simulation compiles the engine, which takes a minute on a
# busy machine.
READY_SECONDS = 180.0


class SimulatorSession:
    """A simulation of robots, and its recording, which is available after the block."""

    def __init__(self) -> None:
        self.recording: Recording | None = None

    @property
    def track(self) -> Player | Notice:
        """The robots' tracks, as a player or as a picture."""
        if self.recording is None:
            return Notice("The robot has not been simulated yet.")
        from sim.view import Player

        return Player(self.recording, play=True)


@contextmanager
def simulator(
    world: str = "empty_room", speed: float = 1.0, robots: Sequence[str] = ("",)
) -> Iterator[SimulatorSession]:
    """Simulate robots while the block runs. The simulator publishes /scan, /odom, /clock and subscribes to /cmd_vel.

    The simulator is a separate program, like a real robot. Its log is printed in the cell. The robots are as large as
    in `drive`.

    Args:
        world: name of the world.
        speed: simulated seconds per second of real time.
        robots: the namespace of each robot; "" means no namespace.

    Raises:
        UsageError: the world does not exist.
    """
    path = course_paths.world_path(world)
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
