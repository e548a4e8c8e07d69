"""The frames of a GIF or a video: the same pixels in any order, without empty bands, with names and obstacles."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sim import Command, Recording, RobotSpec, Scan, Simulation, World, box, load_world
from sim.view.renderer import Renderer
from sim.view.session import Session
from sim.view.theme import DARK, LIGHT

ROOT = Path(__file__).resolve().parents[3]
SECOND = 1_000_000_000


def drive_forward(scan: Scan) -> Command:
    return Command(0.3, 0.0)


@pytest.mark.parametrize("theme", [LIGHT, DARK])
def test_a_blitted_frame_is_the_same_as_a_fresh_one(world: World, theme: Any) -> None:
    session = Session(Simulation(world), drive_forward)
    session.advance(3 * SECOND)
    used = Renderer(session.simulation, theme)
    for frame in session.frames[::20]:
        used.draw(frame, session.tracks(frame.state.time_ns)[:, 0])
    last = session.frames[-1]
    track = session.tracks(last.state.time_ns)[:, 0]
    reused, fresh = used.draw(last, track), Renderer(session.simulation, theme).draw(last, track)
    assert np.array_equal(np.asarray(reused), np.asarray(fresh))


@pytest.mark.parametrize("size", [(12.0, 8.0), (8.0, 2.0), (2.0, 8.0), (3.0, 3.0)])
def test_a_frame_has_no_empty_band_beside_or_below_the_world(size: tuple[float, float]) -> None:
    session = Session(Simulation(World.from_segments(box(*size))))
    picture = np.asarray(Renderer(session.simulation, LIGHT).draw(session.at(0))).astype(int)
    is_drawn = np.abs(picture - 255).max(axis=2) > 4
    rows, columns = np.flatnonzero(is_drawn.any(axis=1)), np.flatnonzero(is_drawn.any(axis=0))
    assert picture.shape[0] - rows[-1] < 40
    assert picture.shape[1] - columns[-1] < 40


def test_a_frame_names_robots_if_there_are_several(recording: Recording) -> None:
    def frame(*names: str) -> Any:
        session = Session(replace(recording.simulation, robots=tuple(RobotSpec(name=name) for name in names)))
        return np.asarray(Renderer(session.simulation, LIGHT).draw(session.at(0))).astype(int)

    difference = np.abs(frame("one", "two") - frame("one", "else")).max(axis=2) > 60
    assert difference.sum() > 20


def test_a_moving_obstacle_moves_in_the_picture() -> None:
    world = load_world(ROOT / "assets" / "worlds" / "moving_obstacle.yaml")
    session = Session(Simulation(world))
    session.advance(2 * SECOND)
    renderer = Renderer(session.simulation, LIGHT)
    first, last = (np.asarray(renderer.draw(session.at(instant))) for instant in (0, 2 * SECOND))
    assert (np.abs(first[60:, :600].astype(int) - last[60:, :600]).max(axis=2) > 60).sum() > 200
