"""A short run with a moving obstacle, a scan without return, commands and a second robot."""

from __future__ import annotations

from pathlib import Path

import pytest

from sim import Command, OdometryDrift, Recording, RobotSpec, Simulation, load_world, run

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="session")
def recording() -> Recording:
    world = load_world(ROOT / "assets" / "worlds" / "lab.yaml")
    drift = OdometryDrift(linear=0.01, angular=0.02, veer=0.01)
    robots = (RobotSpec(name="one", drift=drift), RobotSpec(name="two", namespace="two"))
    commands = {"one": Command(0.3, 0.2), "two": Command(0.0, 0.5)}
    return run(Simulation(world, robots), lambda state, scans: commands, 3.0)
