"""A world as an occupancy grid: occupied, free and unknown cells."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from sim import World, WorldError, box, load_world
from sim.maps.grid import FREE, OCCUPIED, UNKNOWN, grid_of

WORLDS = Path(__file__).resolve().parents[3] / "assets" / "worlds"


def test_walls_and_pillars_are_occupied_and_reachable_cells_are_free() -> None:
    world = load_world(WORLDS / "lab.yaml")
    grid = grid_of(world, 0.05)
    for x1, y1, x2, y2 in world.segments.tolist():
        for share in np.linspace(0.0137, 0.9861, 50):  # between the corners of cells
            assert grid.cells[grid.cell_of(x1 + share * (x2 - x1), y1 + share * (y2 - y1))] == OCCUPIED
    for x, y, radius in world.circles.tolist():
        assert grid.cells[grid.cell_of(x + radius, y)] == OCCUPIED
        assert grid.cells[grid.cell_of(x, y)] == UNKNOWN  # the inside is never seen
    for start in world.starts:
        assert grid.cells[grid.cell_of(start.x, start.y)] == FREE
    assert grid.cells[grid.cell_of(4.0, 4.0)] == FREE


def test_the_grid_has_an_edge_of_unknown_cells_around_the_walls() -> None:
    grid = grid_of(World.from_segments(box(2.0, 1.0)), 0.1)
    assert set(grid.cells[0]) == set(grid.cells[-1]) == {UNKNOWN}
    assert set(grid.cells[:, 0]) == set(grid.cells[:, -1]) == {UNKNOWN}
    rows, columns = np.nonzero(grid.cells == OCCUPIED)
    assert grid.y + 0.1 * rows.min() <= -0.5 < grid.y + 0.1 * (rows.min() + 1) + 1e-9
    assert grid.x + 0.1 * columns.min() <= -1.0 < grid.x + 0.1 * (columns.min() + 1) + 1e-9
    assert (grid.cells == FREE).sum() >= 19 * 9


def test_a_grid_without_bound_is_refused() -> None:
    with pytest.raises(WorldError, match=r"more than 4000000\. Choose a larger resolution"):
        grid_of(World.from_segments(box(1000.0, 1000.0)), 0.05)
