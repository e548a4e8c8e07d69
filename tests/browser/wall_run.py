"""A run that ends at a wall, for the pages that play it."""

from __future__ import annotations

from autograder.result.artifacts import Artifacts
from autograder.suite import temporal
from sim import Command, RobotSpec, Simulation, World, box, run

ROOM = World.from_segments(box(4.0, 3.0), name="a room")
RUN = run(Simulation(ROOM, (RobotSpec(radius=0.18),)), lambda state, scans: Command(linear=0.5), seconds=5.0)


def save_run(artifacts: Artifacts, check: str) -> None:
    """Save the run as an artifact of a check, with a rule that it breaks."""
    verdict = temporal.always("gap > 0.01", RUN.times.tolist(), {"gap": RUN.clearances[:, 0].tolist()})
    artifacts.of(check).track("track", RUN, f"The run of {check}.", mark=3.0, rules={"the gap, in m": verdict})
