"""A short run among walls, with a collision in it."""

from __future__ import annotations

from pathlib import Path

import pytest

from sim import Command, Recording, RobotSpec, Simulation, World, load_world, run

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="session")
def world() -> World:
    return load_world(ROOT / "assets" / "worlds" / "lab.yaml")


@pytest.fixture(scope="session")
def recording(world: World) -> Recording:
    """Eight seconds straight on into a bench, and a second robot that turns on the spot."""
    robots = (RobotSpec(name="one"), RobotSpec(name="two"))
    commands = {"one": Command(0.4, 0.3), "two": Command(0.0, 0.5)}
    return run(Simulation(world, robots), lambda state, scans: commands, 8.0)
