"""Converts cells to walls: traces the outline of a grid's occupied cells as directed segments.

The outline consists of the edges between an occupied cell and one that is not. With the occupied side on the left, they
form closed loops, outer ones anticlockwise and holes clockwise. Collinear edges are joined to one segment. The result
is exact: a point is inside an occupied cell if and only if it is inside the outline.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

Grid = npt.NDArray[np.bool_]
Loop = npt.NDArray[np.float64]
Corner = tuple[int, int]
Edge = tuple[Corner, int]
Edges = dict[Corner, list[int]]

_EAST, _NORTH, _WEST, _SOUTH = range(4)
_STEP = ((1, 0), (0, 1), (-1, 0), (0, -1))


def count_edges(occupied: Grid) -> int:
    """Return the number of unit edges in the outline of `occupied` (H, W)."""
    padded_cells = np.pad(occupied, 1)
    return int((padded_cells[1:] != padded_cells[:-1]).sum() + (padded_cells[:, 1:] != padded_cells[:, :-1]).sum())


def trace_loops(occupied: Grid) -> list[Loop]:
    """Return the closed outlines of the occupied cells, as corners.

    `occupied` is (H, W), row 0 the lowest (y grows with the row). Each loop is (K, 2) float64 corners in cells, x then
    y, without repeating the first. Two cells that touch only at a corner belong to separate loops.
    """
    edges = _directed_edges(occupied)
    remaining_edges = {(corner, direction) for corner, directions in edges.items() for direction in directions}
    loops = []
    for corner, directions in edges.items():
        for direction in directions:
            if (corner, direction) in remaining_edges:
                loop = list(_walk(edges, (corner, direction)))
                remaining_edges.difference_update(loop)
                loops.append(_corners(loop))
    return loops


def simplify(loop: Loop, tolerance: float) -> Loop:
    """Drop the corners whose removal moves the outline by at most `tolerance` (in the unit of the loop).

    The method is that of Ramer (1972) and of Douglas and Peucker (1973), for the two halves of the loop between its
    first corner and the corner farthest from it. A loop that would lose its area is returned unchanged.
    """
    if tolerance <= 0.0 or len(loop) < 4:
        return loop
    farthest = int(np.argmax(np.hypot(*(loop - loop[0]).T)))
    closed_loop = np.vstack([loop, loop[:1]])
    indices = sorted(
        set(_significant(closed_loop, 0, farthest, tolerance))
        | set(_significant(closed_loop, farthest, len(loop), tolerance))
    )
    corners = closed_loop[[index for index in indices if index < len(loop)]]
    return corners if len(corners) >= 3 else loop


def loop_segments(loops: list[Loop]) -> npt.NDArray[np.float64]:
    """Return the sides of all loops as (N, 4) float64 rows x1, y1, x2, y2."""
    sides = [np.hstack([loop, np.roll(loop, -1, axis=0)]) for loop in loops]
    return np.concatenate(sides) if sides else np.empty((0, 4))


def roomiest_point(free: Grid) -> tuple[float, float] | None:
    """Return the centre, in cells, of the largest square of free cells, or None if no cell is free.

    The side is found by bisection, and a summed-area table tests each side in one step: O(HW log min(H, W)). Of several
    squares with that side, the one nearest to the grid's centre is chosen, as a person would do.
    """
    height, width = free.shape
    area = np.zeros((height + 1, width + 1), dtype=np.int64)
    area[1:, 1:] = free.cumsum(axis=0, dtype=np.int64).cumsum(axis=1)

    def squares(side: int) -> npt.NDArray[np.intp]:
        count = area[side:, side:] - area[:-side, side:] - area[side:, :-side] + area[:-side, :-side]
        return np.argwhere(count == side * side)

    low, high = 0, min(height, width)
    while low < high:
        side = (low + high + 1) // 2
        low, high = (side, high) if len(squares(side)) else (low, side - 1)
    if low == 0:
        return None
    centres = squares(low) + low / 2
    offset = centres - np.array([height / 2, width / 2])
    row, column = centres[int(np.argmin((offset**2).sum(axis=1)))]
    return float(column), float(row)


def _directed_edges(occupied: Grid) -> Edges:
    """Map each corner (x, y) to the directions of the unit edges that leave it, occupied side on the left."""
    padded_cells = np.pad(occupied, 1)
    below, above = padded_cells[:-1, 1:-1], padded_cells[1:, 1:-1]
    left, right = padded_cells[1:-1, :-1], padded_cells[1:-1, 1:]
    edges: Edges = {}
    for mask, direction, dx, dy in (
        (above & ~below, _EAST, 0, 0),
        (below & ~above, _WEST, 1, 0),
        (left & ~right, _NORTH, 0, 0),
        (right & ~left, _SOUTH, 0, 1),
    ):
        rows, columns = np.nonzero(mask)
        for x, y in zip((columns + dx).tolist(), (rows + dy).tolist(), strict=True):
            edges.setdefault((x, y), []).append(direction)
    return edges


def _walk(edges: Edges, first: Edge) -> Iterator[Edge]:
    """Yield the edges of the loop that starts with `first`.

    At a corner that two diagonal cells share, it turns left and so stays at the same cell.
    """
    edge = first
    while True:
        yield edge
        (x, y), heading = edge
        corner = (x + _STEP[heading][0], y + _STEP[heading][1])
        outgoing_directions = edges[corner]
        turn = next(d for d in ((heading + 1) % 4, heading, (heading - 1) % 4) if d in outgoing_directions)
        edge = (corner, turn)
        if edge == first:
            return


def _corners(loop: list[Edge]) -> Loop:
    """Return the points at which the direction changes."""
    previous_edges = [loop[-1], *loop[:-1]]
    points = [edge[0] for edge, last in zip(loop, previous_edges, strict=True) if edge[1] != last[1]]
    return np.array(points, dtype=np.float64)


def _significant(points: Loop, first: int, last: int, tolerance: float) -> list[int]:
    """Return the indices to keep from `first` to `last`, both included. It does not recurse, as loops can be long."""
    indices, stack = [first, last], [(first, last)]
    while stack:
        a, b = stack.pop()
        if b - a < 2:
            continue
        chord = points[b] - points[a]
        offsets = points[a + 1 : b] - points[a]
        length = math.hypot(*chord)
        if length == 0.0:
            distance = np.hypot(offsets[:, 0], offsets[:, 1])
        else:
            distance = np.abs(chord[0] * offsets[:, 1] - chord[1] * offsets[:, 0]) / length
        worst = int(np.argmax(distance))
        if distance[worst] > tolerance:
            middle = a + 1 + worst
            indices.append(middle)
            stack += [(a, middle), (middle, b)]
    return indices
