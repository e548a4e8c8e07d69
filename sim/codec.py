"""Converts a simulation to JSON and back without loss: floats keep their bits."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Any

from sim.exceptions import RecordingError, SimError
from sim.faults import DeadSector, Faults, Window
from sim.lidar import LidarSpec
from sim.pose import Pose
from sim.robot import OdometryDrift, RobotSpec
from sim.state import Simulation
from sim.world import Goal, Mover, World


def to_json(simulation: Simulation) -> str:
    """Return a simulation as one line of JSON."""
    world = simulation.world
    return json.dumps(
        {
            "world": {
                "name": world.name,
                "segments": world.segments.tolist(),
                "circles": world.circles.tolist(),
                "segment_names": world.segment_names,
                "circle_names": world.circle_names,
                "starts": [asdict(pose) for pose in world.starts],
                "goals": [asdict(goal) for goal in world.goals],
                "movers": [asdict(mover) for mover in world.movers],
                "bounds": world.bounds,
            },
            "robots": [asdict(robot) for robot in simulation.robots],
            "seed": simulation.seed,
            "tick": simulation.tick,
        },
        separators=(",", ":"),
    )


def from_json(text: str) -> Simulation:
    """Return the simulation that `to_json` wrote. Raise a RecordingError for any other text."""
    try:
        data = json.loads(text)
        return Simulation(
            world=_world(data["world"]),
            robots=tuple(_robot(robot) for robot in data["robots"]),
            seed=data["seed"],
            tick=data["tick"],
        )
    except (KeyError, TypeError, ValueError, AttributeError, RecursionError, SimError) as error:
        raise RecordingError(f"the description of the run is damaged ({error}); record the run again") from None


def _world(data: dict[str, Any]) -> World:
    return World(
        name=data["name"],
        segments=data["segments"],
        circles=data["circles"],
        segment_names=tuple(data["segment_names"]),
        circle_names=tuple(data["circle_names"]),
        starts=tuple(Pose(**pose) for pose in data["starts"]),
        goals=tuple(Goal(**goal) for goal in data["goals"]),
        movers=tuple(Mover(**{**mover, "path": _points(mover["path"])}) for mover in data["movers"]),
        bounds=tuple(data["bounds"]),
    )


def _robot(data: dict[str, Any]) -> RobotSpec:
    lidar = data["lidar"]
    faults = data["faults"]
    return RobotSpec(
        **{
            **data,
            "footprint": None if data["footprint"] is None else _points(data["footprint"]),
            "lidar": None if lidar is None else LidarSpec(**{**lidar, "mount": Pose(**lidar["mount"])}),
            "drift": OdometryDrift(**data["drift"]),
            "start": None if data["start"] is None else Pose(**data["start"]),
            "faults": Faults(
                dead=tuple(Window(**window) for window in faults["dead"]),
                frozen=tuple(Window(**window) for window in faults["frozen"]),
                sectors=tuple(
                    DeadSector(**{**sector, "window": Window(**sector["window"])}) for sector in faults["sectors"]
                ),
            ),
        }
    )


def _points(points: list[list[float]]) -> tuple[tuple[float, float], ...]:
    return tuple((x, y) for x, y in points)
