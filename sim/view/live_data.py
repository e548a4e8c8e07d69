"""The data of a live view for the page: the description of the run, and a frame for each instant.

Both use the names, units and codes of a recorded run (`sim.view.run_data`), so that the page draws them by the same
code. A frame contains everything that is shown, so a page can be opened at any time, and can skip frames.
"""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np
import numpy.typing as npt

from sim.lidar import Scan
from sim.pose import Pose
from sim.simulation import clearance
from sim.state import RobotState, Simulation
from sim.view.figures import size_of, title_of
from sim.view.names import names_of
from sim.view.run_data import (
    LADDER,
    beam_step_of,
    encode_collision,
    encode_lidar,
    encode_shape,
    encode_world,
    range_codes,
)
from sim.view.session import Source
from sim.view.shapes import movers_at
from sim.view.theme import Theme

MAX_BEAMS = LADDER[0][1]
"""The maximum number of beams of a scan in a frame."""

MAX_COLLISIONS = 100
"""The maximum number of collisions in a frame, the newest ones."""

NO_GAP = 1e3
"""The code for the distance of the nearest obstacle, in metres, if there is none."""


def describe(source: Source, theme: Theme, *, names: bool) -> dict[str, Any]:
    """Return what does not change during a run: the world, the robots, the colours, and what can be controlled.

    Args:
        source: the run.
        theme: the colours.
        names: whether to write the names of walls and goals.
    """
    simulation = source.simulation
    world = simulation.world
    robots = [
        {
            **encode_shape(spec),
            "scans": None if spec.lidar is None else encode_lidar(spec.lidar, beam_step_of(spec.lidar, MAX_BEAMS)),
        }
        for spec in simulation.robots
    ]
    return {
        "title": title_of(world),
        "summary": size_of(world),
        "alt": f"Live view of the world “{world.name}”, {size_of(world)}",
        "world": encode_world(world),
        "names": [asdict(name) for name in names_of(world)] if names else [],
        "robots": robots,
        "colours": theme.named,
        "paced": source.paced,
        "drivable": source.growing,
        "releasable": source.can_be_released,
    }


def frame_data(source: Source, time_ns: int) -> dict[str, Any]:
    """Return an instant of a run. Numbers are in s, m, rad, m/s and rad/s; a track is (K, 2) float32, as bytes."""
    simulation, frame, tracks = source.simulation, source.at(time_ns), source.tracks(time_ns).astype("<f4")
    state = frame.state
    return {
        "time": time_ns / 1e9,
        "end": source.end_ns / 1e9,
        "movers": movers_at(simulation, state.time_ns),
        "collisions": [encode_collision(event) for event in source.collisions(time_ns)[-MAX_COLLISIONS:]],
        "robots": [
            {
                **_encode_state(robot),
                "gap": min(NO_GAP, clearance(simulation, state, robot.name).distance),
                "scan": _encode_scan(simulation, index, frame.scans[index]),
                "track": _as_bytes(tracks[:, index]),
            }
            for index, robot in enumerate(state.robots)
        ],
    }


def _encode_state(robot: RobotState) -> dict[str, Any]:
    has_command = robot.command_ns > 0 or robot.command.linear != 0.0 or robot.command.angular != 0.0
    return {
        "pose": [robot.pose.x, robot.pose.y, robot.pose.theta],
        "velocity": [robot.velocity.linear, robot.velocity.angular],
        "command": [robot.command.linear, robot.command.angular] if has_command else None,
        "blocked": robot.collided,
    }


def _encode_scan(simulation: Simulation, index: int, newest: tuple[Scan, Pose] | None) -> dict[str, Any] | None:
    lidar = simulation.robots[index].lidar
    if lidar is None or newest is None:
        return None
    scan, pose = newest
    ranges = range_codes(scan.ranges[:: beam_step_of(lidar, MAX_BEAMS)])
    return {"pose": [pose.x, pose.y, pose.theta], "ranges": _as_bytes(ranges)}


def _as_bytes(numbers: npt.NDArray[np.floating[Any]]) -> bytes:
    return np.ascontiguousarray(numbers, dtype="<f4").tobytes()
