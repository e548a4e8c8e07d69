"""Outlines of occupied cells: exact, closed and correctly oriented."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from sim.maps.trace import count_edges, loop_segments, roomiest_point, simplify, trace_loops

grids = arrays.arrays(np.bool_, st.tuples(st.integers(1, 12), st.integers(1, 12)))


def area(loop: npt.NDArray[np.float64]) -> float:
    """The signed area of a loop: positive if it goes round anticlockwise."""
    x, y = loop.T
    return float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) / 2)


def inside(segments: npt.NDArray[np.float64], x: float, y: float) -> bool:
    """Whether a ray from the point to the east crosses the segments an odd number of times."""
    x1, y1, x2, y2 = segments.T
    crosses = (y1 > y) != (y2 > y)
    height = np.where(crosses, y2 - y1, 1.0)
    at = x1 + (y - y1) / height * (x2 - x1)
    return bool(np.sum(crosses & (at > x)) % 2)


def distance(point: npt.NDArray[np.float64], segments: npt.NDArray[np.float64]) -> float:
    """Return the distance of a point from the nearest segment."""
    start, along = segments[:, :2], segments[:, 2:] - segments[:, :2]
    share = np.clip(((point - start) * along).sum(axis=1) / (along**2).sum(axis=1), 0.0, 1.0)
    return float(np.hypot(*(point - start - share[:, None] * along).T).min())


def test_one_cell_is_a_square_that_goes_round_anticlockwise() -> None:
    (loop,) = trace_loops(np.array([[True]]))
    assert loop.tolist() == [[0, 0], [1, 0], [1, 1], [0, 1]]


def test_a_ring_has_an_outer_and_an_inner_loop_that_go_opposite_ways() -> None:
    ring = np.ones((5, 5), dtype=bool)
    ring[1:4, 1:4] = False
    assert sorted(area(loop) for loop in trace_loops(ring)) == [-9.0, 25.0]


def test_two_cells_that_touch_at_a_corner_are_two_loops() -> None:
    assert [area(loop) for loop in trace_loops(np.eye(2, dtype=bool))] == [1.0, 1.0]


@given(grids)
def test_a_cell_is_inside_the_outline_exactly_if_it_is_occupied(grid: npt.NDArray[np.bool_]) -> None:
    segments = loop_segments(trace_loops(grid))
    for (row, column), occupied in np.ndenumerate(grid):
        assert inside(segments, column + 0.5, row + 0.5) == occupied


@given(grids)
def test_the_outline_has_the_area_and_the_length_of_the_cells(grid: npt.NDArray[np.bool_]) -> None:
    loops = trace_loops(grid)
    segments = loop_segments(loops)
    assert sum(area(loop) for loop in loops) == grid.sum()
    assert np.abs(segments[:, 2:] - segments[:, :2]).sum() == count_edges(grid)


@given(grids)
def test_no_corner_of_an_outline_lies_on_a_straight_line(grid: npt.NDArray[np.bool_]) -> None:
    for loop in trace_loops(grid):
        before, after = loop - np.roll(loop, 1, axis=0), np.roll(loop, -1, axis=0) - loop
        assert (before[:, 0] * after[:, 1] != before[:, 1] * after[:, 0]).all()


@given(grids, st.floats(0.0, 3.0))
def test_simplifying_moves_no_corner_by_more_than_the_tolerance(grid: npt.NDArray[np.bool_], tolerance: float) -> None:
    for loop in trace_loops(grid):
        simpler = simplify(loop, tolerance)
        assert len(simpler) <= len(loop)
        segments = loop_segments([simpler])
        assert max(distance(corner, segments) for corner in loop) <= tolerance + 1e-9


def test_stairs_become_a_slope() -> None:
    stairs = np.tri(20, dtype=bool)
    (loop,) = trace_loops(stairs)
    assert len(simplify(loop, 1.0)) <= 5 < len(loop)


def test_the_roomiest_place_is_the_middle_of_the_largest_free_square() -> None:
    free = np.zeros((10, 20), dtype=bool)
    free[1:4, 1:4] = True
    free[2:9, 10:17] = True
    assert roomiest_point(free) == (13.5, 5.5)


@given(grids)
def test_the_roomiest_place_is_free_if_any_is(grid: npt.NDArray[np.bool_]) -> None:
    point = roomiest_point(grid)
    if point is None:
        assert not grid.any()
    else:
        x, y = point
        assert grid[min(int(y), grid.shape[0] - 1), min(int(x), grid.shape[1] - 1)]


def test_an_empty_grid_has_no_walls() -> None:
    assert loop_segments(trace_loops(np.zeros((3, 3), dtype=bool))).shape == (0, 4)
    assert count_edges(np.zeros((3, 3), dtype=bool)) == 0
    assert roomiest_point(np.zeros((2, 2), dtype=bool)) is None
