"""Ranges of single beams, from any origin in any direction, and through a grid of cells if there are many walls.

The grid contains, for each square cell, the walls that pass within `MARGIN` of it. So a beam still meets its wall if
rounding puts it into the neighbouring cell. A beam is followed from cell to cell, until the wall that it has met is
nearer than the next cell. The time depends on the free space in front of the beam, not on the size of the world.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from sim.engine.exact import ERROR_BOUND
from sim.engine.loops import circle_into
from sim.engine.pairs import NOTHING, TOUCHING, circle_inverse, wall_hit, wall_inverse
from sim.engine.trig import sincos

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

MARGIN = 1e-6
FLAT = 1e-12  # with a smaller component of its direction, a beam stays in its column or row, within the margin
NEVER = 1e300


def beam_ranges(walls: Floats, circles: Floats, origins: Floats, directions: Floats) -> Floats:
    """Return the ranges (K,) of beams from `origins` (K, 2) along the unit vectors `directions` (K, 2), in metres."""
    ranges = np.empty(len(origins))
    for beam in range(len(origins)):
        ox, oy = origins[beam, 0], origins[beam, 1]
        dx, dy = directions[beam, 0], directions[beam, 1]
        best = NOTHING
        for k in range(walls.shape[1]):
            px, qx, py, qy = walls[0, k], walls[1, k], walls[2, k], walls[3, k]
            best = max(best, wall_hit(dx, dy, ox, oy, px, py, qx, qy, walls[5, k], walls[4, k]))
        for k in range(len(circles)):
            cx, cy, radius = circles[k, 0], circles[k, 1], circles[k, 2]
            vx = cx - ox
            vy = cy - oy
            if vx * vx + vy * vy <= radius * radius:
                best = TOUCHING
            else:
                best = max(best, circle_inverse(dx, dy, ox, oy, cx, cy, radius))
        ranges[beam] = 1.0 / best
    return ranges


def follow_beam(
    walls: Floats,
    starts: Integers,
    members: Integers,
    west: float,
    south: float,
    cell: float,
    columns: int,
    rows: int,
    ox: float,
    oy: float,
    dx: float,
    dy: float,
    reach: float,
) -> float:
    """Return the largest inverse range of the walls in the grid along one beam."""
    best = NOTHING
    x, y = ox - west, oy - south
    width, height = cell * columns, cell * rows
    per_x = 1.0 / dx if abs(dx) >= FLAT else 0.0
    per_y = 1.0 / dy if abs(dy) >= FLAT else 0.0
    entry = 0.0
    if x < 0.0 or x > width or y < 0.0 or y > height:  # outside the grid: start where the beam enters it
        departure = reach
        for o, per, size in ((x, per_x, width), (y, per_y, height)):
            if per != 0.0:
                a, b = -o * per, (size - o) * per
                entry = max(entry, min(a, b))
                departure = min(departure, max(a, b))
            elif o < -MARGIN or o > size + MARGIN:
                return best
        if entry > departure + MARGIN:
            return best
    per_cell = 1.0 / cell
    column = min(max(int((x + entry * dx) * per_cell), 0), columns - 1)
    row = min(max(int((y + entry * dy) * per_cell), 0), rows - 1)
    doubt = 4.0 * ERROR_BOUND * (abs(x) + abs(y) + width + height)
    column_step = 1 if dx > 0.0 else -1
    row_step = 1 if dy > 0.0 else -1
    next_column = (cell * (column + (column_step + 1) // 2) - x) * per_x if per_x != 0.0 else NEVER
    next_row = (cell * (row + (row_step + 1) // 2) - y) * per_y if per_y != 0.0 else NEVER
    per_x = cell * abs(per_x)
    per_y = cell * abs(per_y)
    while True:
        cell_index = row * columns + column
        for index in range(starts[cell_index], starts[cell_index + 1]):
            k = members[index]
            px, qx, py, qy = walls[0, k], walls[1, k], walls[2, k], walls[3, k]
            vx = px - ox
            vy = py - oy
            before = dx * vy - dy * vx
            after = dx * (qy - oy) - dy * (qx - ox)
            ey = walls[4, k]
            ex = walls[5, k]
            if (before > doubt and after > doubt) or (before < -doubt and after < -doubt):
                continue  # the usual case: both ends are clearly on the same side of the beam
            h = vx * ey - vy * ex
            if min(abs(before), abs(after)) <= doubt or abs(h) <= doubt * walls[6, k]:
                best = max(best, wall_hit(dx, dy, ox, oy, px, py, qx, qy, ex, ey))
            elif (h > 0.0) == (after > 0.0):
                best = max(best, wall_inverse(dx, dy, ox, oy, px, py, qx, qy, ex, ey))
        next_cell = min(next_column, next_row)
        if next_cell > reach or next_cell * best > 1.0 + MARGIN * best:
            return best
        if next_column < next_row:
            column += column_step
            next_column += per_x
        else:
            row += row_step
            next_row += per_y
        if column < 0 or column >= columns or row < 0 or row >= rows:
            return best


def scan_ranges_in_grid(
    walls: Floats,
    starts: Integers,
    members: Integers,
    west: float,
    south: float,
    cell: float,
    columns: int,
    rows: int,
    circles: Floats,
    table: Floats,
    ox: float,
    oy: float,
    yaw: float,
    angle_min: float,
    per_radian: float,
    reach: float,
) -> Floats:
    """Return the ranges of a scan, as `loops.scan_ranges` does, but with the walls sorted into an `index.Grid`."""
    s, c = sincos(yaw)
    count = table.shape[1]
    directions = np.empty((2, count))
    best = np.empty(count)
    for beam in range(count):
        dx = c * table[0, beam] - s * table[1, beam]
        dy = s * table[0, beam] + c * table[1, beam]
        directions[0, beam] = dx
        directions[1, beam] = dy
        best[beam] = follow_beam(walls, starts, members, west, south, cell, columns, rows, ox, oy, dx, dy, reach)
    for k in range(len(circles)):
        circle_into(
            best, directions, ox, oy, (circles[k, 0], circles[k, 1], circles[k, 2]), yaw + angle_min, per_radian
        )
    for beam in range(count):
        best[beam] = 1.0 / best[beam]
    return best
