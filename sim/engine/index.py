"""The walls of a world laid out for the engines: as columns, and above some 300 of them in a grid of cells."""

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
    """Square cells of `cell` metres from (`west`, `south`): `members[starts[i]:starts[i + 1]]` are in cell i."""

    starts: Integers
    members: Integers
    west: float
    south: float
    cell: float
    columns: int
    rows: int


def layout(segments: Floats) -> Floats:
    """Return the walls (N, 4) as the engines want them, (7, N): x1, x2, y1, y2, dy, dx, |dx| + |dy|."""
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

    # one entry for each wall and each column of cells that it passes through
    left = np.clip(((np.minimum(x1, x2) - MARGIN - west) / cell).astype(np.int64), 0, columns - 1)
    right = np.clip(((np.maximum(x1, x2) + MARGIN - west) / cell).astype(np.int64), 0, columns - 1)
    wall, column = _spread(left, right)
    # where the wall is while it is in that column, from the wall's own ends where it is nearly upright
    ex, ey = x2 - x1, y2 - y1
    upright = np.abs(ex) <= 1e-3
    slope = np.divide(ey, ex, out=np.zeros_like(ex), where=~upright)
    begin = west + cell * column - MARGIN
    ya = y1[wall] + slope[wall] * (begin - x1[wall])
    yb = ya + slope[wall] * (cell + 2 * MARGIN)
    low, high = np.minimum(y1, y2)[wall], np.maximum(y1, y2)[wall]
    slack = MARGIN + 1e-8 * np.abs(ey)[wall]
    bottom = np.where(upright[wall], low, np.maximum(low, np.minimum(ya, yb))) - slack
    top = np.where(upright[wall], high, np.minimum(high, np.maximum(ya, yb))) + slack
    entry, row = _spread(
        np.clip(((bottom - south) / cell).astype(np.int64), 0, rows - 1),
        np.clip(((top - south) / cell).astype(np.int64), 0, rows - 1),
    )
    place = row * columns + column[entry]
    order = np.argsort(place, kind="stable")
    starts = np.zeros(columns * rows + 1, dtype=np.int64)
    np.cumsum(np.bincount(place, minlength=columns * rows), out=starts[1:])
    return Grid(starts, wall[entry][order], west, south, cell, columns, rows)


def _spread(first: Integers, last: Integers) -> tuple[Integers, Integers]:
    """Return (which, value) of all the integers from `first[which]` to `last[which]`, both included."""
    lengths = np.maximum(last - first + 1, 0)
    which = np.repeat(np.arange(len(first)), lengths)
    value = np.arange(len(which)) - np.repeat(lengths.cumsum() - lengths - first, lengths)
    return which, value
