"""Reads ROS maps (a YAML file and a picture for nav2's map_server) as worlds. The picture is traced into walls.

    >>> from sim.maps import load_map
    >>> world = load_map("assets/worlds/office.yaml")

The outlines follow the cells exactly. With a `tolerance`, they consist of fewer walls, and slanted walls have no steps.
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
"""The maximum number of unit edges of an outline. A floor plan has fewer; a photograph or noise has more."""

__all__ = ["MAX_EDGES", "MapFile", "load", "load_map", "read_map_file"]


def load(path: str | Path) -> World:
    """Read the YAML file of a world or of a ROS map.

    Raises:
        WorldError: the file cannot be read or is invalid.
    """
    return load_map(path) if is_map_file(Path(path)) else load_world(path)


def load_map(
    path: str | Path, *, starts: Iterable[Pose] = (), goals: Iterable[Goal] = (), tolerance: float = 0.0
) -> World:
    """Read a map_server YAML file and its picture, and trace the occupied cells into segments, in metres, frame `map`.

    A cell is occupied if its shade is above `occupied_thresh` or, in the mode `raw`, if its value, 0 to 100, is at
    least 100 times that threshold. Unknown cells are not walls.

    Args:
        path: the path of the YAML file.
        starts: the start poses of robots, by default the centre of the largest free square.
        goals: places to reach.
        tolerance: the distance in metres by which an outline may be moved to simplify it; 0 keeps it exact.

    Raises:
        WorldError: the file or the picture cannot be read or is invalid.
    """
    path = Path(path)
    if not (math.isfinite(tolerance) and tolerance >= 0.0):
        raise WorldError(f"a tolerance of {tolerance} m makes no sense", "Give 0 or more", path=str(path))
    map_file = read_map_file(path)
    occupied, free = _classify_cells(map_file, _read_picture(map_file, Path(path)))
    edges = count_edges(occupied)
    if edges == 0:
        raise WorldError(
            "no cell is a wall", "Check the picture, 'negate' and 'occupied_thresh'", path=str(map_file.image)
        )
    if edges > MAX_EDGES:
        raise WorldError(
            f"an outline of {edges:,} edges is not a floor plan",
            f"Clean the picture or scale it down to {MAX_EDGES:,} or less",
            path=str(map_file.image),
        )
    loops = [simplify(loop, tolerance / map_file.resolution) for loop in trace_loops(occupied)]
    segments = _to_map(map_file, loop_segments(loops).reshape(-1, 2)).reshape(-1, 4)
    return World.from_segments(
        segments,
        name=path.stem,
        starts=tuple(starts) or _roomiest_start(map_file, free),
        goals=tuple(goals),
    )


def _classify_cells(map_file: MapFile, picture: Shades) -> tuple[npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
    """Return the masks of occupied and of free cells, (H, W), row 0 the lowest."""
    if map_file.mode == "raw":
        level = np.rint(picture.shade * 255.0)
        is_known = level <= 100.0
        occupied = is_known & (level >= 100.0 * map_file.occupied_thresh)
        free = is_known & (level < 100.0 * map_file.free_thresh)
    else:
        occupancy = picture.shade if map_file.negate else 1.0 - picture.shade
        is_known = picture.known if map_file.mode == "scale" else np.ones_like(picture.known)
        occupied = is_known & (occupancy > map_file.occupied_thresh)
        free = is_known & (occupancy < map_file.free_thresh)
    return occupied[::-1], free[::-1]


def _roomiest_start(map_file: MapFile, free: npt.NDArray[np.bool_]) -> tuple[Pose, ...]:
    point = roomiest_point(free)
    if point is None:
        raise WorldError(
            "no cell is free: there is no room for a robot",
            "Check the picture and 'free_thresh'",
            path=str(map_file.image),
        )
    x, y = _to_map(map_file, np.array([point]))[0]
    return (Pose(float(x), float(y), map_file.origin[2]),)


def _to_map(map_file: MapFile, cells: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Convert points in cells, (N, 2), to points in metres in the frame `map`."""
    x, y, yaw = map_file.origin
    cosine, sine = math.cos(yaw), math.sin(yaw)
    across, up = (cells * map_file.resolution).T
    return np.column_stack([x + cosine * across - sine * up, y + sine * across + cosine * up])


def _read_picture(map_file: MapFile, path: Path) -> Shades:
    """Read a map's picture. If it is in another folder, an error names the map, which refers to it."""
    try:
        return read_image(map_file.image)
    except WorldError as error:
        if map_file.image.is_relative_to(path.parent):
            raise
        raise WorldError(f"its picture {map_file.image}: {error.problem}", error.remedy, path=str(path)) from None
