"""Converts a world to an occupancy grid, as a map_server publishes it: the inverse of reading a map."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from sim.exceptions import WorldError
from sim.world import World

FREE, OCCUPIED, UNKNOWN = 0, 100, -1
MAX_CELLS = 4_000_000


@dataclass(frozen=True, eq=False)
class Grid:
    """An occupancy grid.

    Attributes:
        cells: (rows, columns), int8, the first row the southernmost: 0 is free, 100 occupied, -1 unknown.
        resolution: the side of a cell in m.
        x, y: the south-west corner of the first cell, in m, frame `map`.
    """

    cells: npt.NDArray[np.int8]
    resolution: float
    x: float
    y: float

    def cell_of(self, x: float, y: float) -> tuple[int, int]:
        """Return the row and the column of the cell around a point."""
        return math.floor((y - self.y) / self.resolution), math.floor((x - self.x) / self.resolution)


def grid_of(world: World, resolution: float = 0.05) -> Grid:
    """Return a grid with the walls and circles of a world. Cells that cannot be reached from a start are unknown.

    Moving obstacles are not part of a map. Each cell that a wall passes through is occupied.

    Raises:
        WorldError: the grid would have more than `MAX_CELLS` cells.
    """
    left, low, right, high = world.bounds
    x, y = (math.floor(side / resolution - 1e-9) * resolution - resolution for side in (left, low))
    columns, rows = (math.floor((end - start) / resolution + 1e-9) + 2 for start, end in ((x, right), (y, high)))
    if rows * columns > MAX_CELLS:
        raise WorldError(
            f"the world {world.name!r} has {rows} x {columns} cells of {resolution} m, more than {MAX_CELLS}",
            "Choose a larger resolution",
        )
    grid = Grid(np.full((rows, columns), UNKNOWN, dtype=np.int8), resolution, x, y)
    for x1, y1, x2, y2 in world.segments.reshape(-1, 4).tolist():
        cuts = np.unique(np.concatenate([[0.0, 1.0], _cuts(x1, x2, x, resolution), _cuts(y1, y2, y, resolution)]))
        shares = (cuts[1:] + cuts[:-1]) / 2  # the middle of the part of the wall in each cell that it passes through
        _occupy(grid, x1 + shares * (x2 - x1), y1 + shares * (y2 - y1))
    for centre_x, centre_y, radius in world.circles.tolist():
        count = 8 + math.ceil(4 * math.tau * radius / resolution)
        angle = np.linspace(0.0, math.tau, count)
        _occupy(grid, centre_x + radius * np.cos(angle), centre_y + radius * np.sin(angle))
    for start in world.starts:
        _mark_free(grid.cells, grid.cell_of(start.x, start.y))
    return grid


def _cuts(start: float, end: float, origin: float, resolution: float) -> npt.NDArray[np.float64]:
    """Return the points at which a wall crosses the grid's lines of one direction, as shares of its length."""
    if start == end:
        return np.empty(0)
    low, high = sorted((start, end))
    numbers = np.arange(math.ceil((low - origin) / resolution), math.floor((high - origin) / resolution) + 1)
    return np.clip((origin + numbers * resolution - start) / (end - start), 0.0, 1.0)


def _occupy(grid: Grid, x: npt.NDArray[np.float64], y: npt.NDArray[np.float64]) -> None:
    rows = np.floor((y - grid.y) / grid.resolution).astype(int)
    columns = np.floor((x - grid.x) / grid.resolution).astype(int)
    grid.cells[rows, columns] = OCCUPIED


def _mark_free(cells: npt.NDArray[np.int8], start: tuple[int, int]) -> None:
    """Mark as free all cells that can be reached from `start` without a diagonal step."""
    rows, columns = cells.shape
    pending = deque([start])
    while pending:
        row, column = pending.popleft()
        if 0 <= row < rows and 0 <= column < columns and cells[row, column] == UNKNOWN:
            cells[row, column] = FREE
            pending.extend(((row + 1, column), (row - 1, column), (row, column + 1), (row, column - 1)))
