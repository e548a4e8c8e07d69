"""ROS maps as worlds: the YAML and picture of nav2's map_server, traced into walls.

    >>> from sim.maps import load_map
    >>> world = load_map("assets/worlds/office.yaml")

Every outline is exact to the cell. `tolerance` trades exactness for fewer walls: slanted walls lose their stairs.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import numpy.typing as npt

from sim.exceptions import WorldError
from sim.maps.image import Shades, read_image
from sim.maps.mapfile import MapFile, is_map_file, read_map_file
from sim.maps.trace import count_edges, loop_segments, roomiest_point, simplify, trace_loops
from sim.pose import Pose
from sim.world import Goal, World
from sim.worldfile import load_world

MAX_EDGES = 400_000
"""Unit edges of an outline. More of them is a photograph or noise, not a floor plan."""

__all__ = ["MAX_EDGES", "MapFile", "load", "load_map", "read_map_file"]


def load(path: str | Path) -> World:
    """Read a world's YAML file or that of a ROS map, whichever it is.

    Raises:
        WorldError: naming the file, the line where it is known, what is wrong and what to do.
    """
    return load_map(path) if is_map_file(Path(path)) else load_world(path)


def load_map(
    path: str | Path, *, starts: Iterable[Pose] = (), goals: Iterable[Goal] = (), tolerance: float = 0.0
) -> World:
    """Read a map_server YAML file and its picture, and trace the occupied cells into segments, in metres, frame `map`.

    A cell is occupied where its shade passes `occupied_thresh` (in the mode `raw`: its value, 0 to 100, reaches 100
    times that); unknown cells are no walls.

    Args:
        path: of the YAML file.
        starts: where robots start; by default in the middle of the roomiest place.
        goals: places to reach.
        tolerance: in metres, how far an outline may be moved to be simpler; 0 keeps it exact.

    Raises:
        WorldError: names the file, the line where it is known, what is wrong and what to do.
    """
    path = Path(path)
    if not (math.isfinite(tolerance) and tolerance >= 0.0):
        raise WorldError(f"a tolerance of {tolerance} m makes no sense", "Give 0 or more", path=str(path))
    described = read_map_file(path)
    occupied, free = _cells(described, _picture(described, Path(path)))
    edges = count_edges(occupied)
    if edges == 0:
        raise WorldError(
            "no cell is a wall", "Look at the picture, 'negate' and 'occupied_thresh'", path=str(described.image)
        )
    if edges > MAX_EDGES:
        raise WorldError(
            f"an outline of {edges:,} edges is no floor plan",
            f"Clean the picture or scale it down to {MAX_EDGES:,} or less",
            path=str(described.image),
        )
    loops = [simplify(loop, tolerance / described.resolution) for loop in trace_loops(occupied)]
    segments = _to_map(described, loop_segments(loops).reshape(-1, 2)).reshape(-1, 4)
    return World.from_segments(
        segments,
        name=path.stem,
        starts=tuple(starts) or _roomiest_start(described, free),
        goals=tuple(goals),
    )


def _cells(described: MapFile, picture: Shades) -> tuple[npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
    """Return which cells are occupied and which are free, (H, W), row 0 the lowest."""
    if described.mode == "raw":
        level = np.rint(picture.shade * 255.0)
        known = level <= 100.0
        occupied = known & (level >= 100.0 * described.occupied_thresh)
        free = known & (level < 100.0 * described.free_thresh)
    else:
        occupancy = picture.shade if described.negate else 1.0 - picture.shade
        known = picture.known if described.mode == "scale" else np.ones_like(picture.known)
        occupied = known & (occupancy > described.occupied_thresh)
        free = known & (occupancy < described.free_thresh)
    return occupied[::-1], free[::-1]


def _roomiest_start(described: MapFile, free: npt.NDArray[np.bool_]) -> tuple[Pose, ...]:
    point = roomiest_point(free)
    if point is None:
        raise WorldError(
            "no cell is free: there is no place for a robot",
            "Look at the picture and at 'free_thresh'",
            path=str(described.image),
        )
    x, y = _to_map(described, np.array([point]))[0]
    return (Pose(float(x), float(y), described.origin[2]),)


def _to_map(described: MapFile, cells: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Turn points in cells, (N, 2), into points in metres in the frame `map`."""
    x, y, yaw = described.origin
    cosine, sine = math.cos(yaw), math.sin(yaw)
    across, up = (cells * described.resolution).T
    return np.column_stack([x + cosine * across - sine * up, y + sine * across + cosine * up])


def _picture(described: MapFile, path: Path) -> Shades:
    """Read a map's picture; one that lies elsewhere is complained of under the map's name, which led there."""
    try:
        return read_image(described.image)
    except WorldError as error:
        if described.image.is_relative_to(path.parent):
            raise
        raise WorldError(f"its picture {described.image}: {error.problem}", error.remedy, path=str(path)) from None
