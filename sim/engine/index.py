"""The walls of a world in the form that engines need: as columns and, if there are many, also in a grid of cells."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim.engine.traverse import MARGIN

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

MAX_WALLS_WITHOUT_GRID = 300


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """Square cells of `cell` metres from (`west`, `south`). Cell i contains `members[starts[i]:starts[i + 1]]`."""

    starts: Integers
    members: Integers
    west: float
    south: float
    cell: float
    columns: int
    rows: int


def layout(segments: Floats) -> Floats:
    """Return the walls (N, 4) as columns (7, N) for the engines: x1, x2, y1, y2, dy, dx, |dx| + |dy|."""
    x1, y1, x2, y2 = segments.T
    ex, ey = x2 - x1, y2 - y1
    walls = np.ascontiguousarray(np.stack((x1, x2, y1, y2, ey, ex, np.abs(ex) + np.abs(ey))))
    return walls


def grid_of(walls: Floats) -> Grid:
    """Sort the walls (7, N) into a grid of about as many cells as there are walls."""
    x1, x2, y1, y2 = walls[:4]
    west, south = min(x1.min(), x2.min()), min(y1.min(), y2.min())
    width = max(x1.max(), x2.max()) - west + 4 * MARGIN
    height = max(y1.max(), y2.max()) - south + 4 * MARGIN
    west, south = float(west - 2 * MARGIN), float(south - 2 * MARGIN)
    cell = float(max(np.sqrt(width * height / walls.shape[1]), max(width, height) / 1000.0, 1e-3))
    columns, rows = int(width / cell) + 1, int(height / cell) + 1

    # One entry for each wall and each column of cells that it passes through.
    left = np.clip(((np.minimum(x1, x2) - MARGIN - west) / cell).astype(np.int64), 0, columns - 1)
    right = np.clip(((np.maximum(x1, x2) + MARGIN - west) / cell).astype(np.int64), 0, columns - 1)
    wall, column = _expand_ranges(left, right)
    # The wall's range of y in this column. A nearly vertical wall has the range between its ends.
    ex, ey = x2 - x1, y2 - y1
    is_vertical = np.abs(ex) <= 1e-3
    slope = np.divide(ey, ex, out=np.zeros_like(ex), where=~is_vertical)
    column_start = west + cell * column - MARGIN
    ya = y1[wall] + slope[wall] * (column_start - x1[wall])
    yb = ya + slope[wall] * (cell + 2 * MARGIN)
    low, high = np.minimum(y1, y2)[wall], np.maximum(y1, y2)[wall]
    slack = MARGIN + 1e-8 * np.abs(ey)[wall]
    bottom = np.where(is_vertical[wall], low, np.maximum(low, np.minimum(ya, yb))) - slack
    top = np.where(is_vertical[wall], high, np.minimum(high, np.maximum(ya, yb))) + slack
    entry, row = _expand_ranges(
        np.clip(((bottom - south) / cell).astype(np.int64), 0, rows - 1),
        np.clip(((top - south) / cell).astype(np.int64), 0, rows - 1),
    )
    cell_index = row * columns + column[entry]
    order = np.argsort(cell_index, kind="stable")
    starts = np.zeros(columns * rows + 1, dtype=np.int64)
    np.cumsum(np.bincount(cell_index, minlength=columns * rows), out=starts[1:])
    return Grid(starts, wall[entry][order], west, south, cell, columns, rows)


def _expand_ranges(first: Integers, last: Integers) -> tuple[Integers, Integers]:
    """Return (index, value) for all integers from `first[index]` to `last[index]`, both included."""
    lengths = np.maximum(last - first + 1, 0)
    index = np.repeat(np.arange(len(first)), lengths)
    value = np.arange(len(index)) - np.repeat(lengths.cumsum() - lengths - first, lengths)
    return index, value
