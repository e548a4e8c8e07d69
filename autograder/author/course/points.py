"""Compares the points of a notebook's grade cells with those of its hidden suite.

Cells that a person grades are ignored, because the suite has no points for them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial

from nbformat import NotebookNode

from autograder.author.course.cells import group, is_graded, is_manually_graded
from autograder.author.course.findings import Difference, Finding


def point_differences(name: str, notebook: NotebookNode, points: Mapping[str, float]) -> Iterator[Difference]:
    """Yield the grade cells whose points, group or order differ from the suite's, and the groups without a cell.

    Findings refer to the notebook by `name`. `points` are the points of each group of its hidden suite.
    """
    named_groups: dict[str, None] = {}
    for cell in notebook.cells:
        if not is_graded(cell) or is_manually_graded(cell):
            continue
        group_name, cell_points = group(cell), cell.metadata.nbgrader.get("points")
        if group_name is None or group_name not in points:
            message = f"names the unknown group {group_name!r}; the suite's groups are {', '.join(points) or 'none'}"
            yield Finding(name, cell.id, message), None
        elif group_name in named_groups:
            yield Finding(name, cell.id, f"is the second cell of group {group_name!r}"), None
        elif cell_points != points[group_name]:
            message = f"has {cell_points} points, but the checks of {group_name!r} have {points[group_name]:g}"
            set_points = partial(cell.metadata.nbgrader.__setitem__, "points", points[group_name])
            yield Finding(name, cell.id, message), set_points
        named_groups.setdefault(str(group_name))
    for group_name in points:
        if group_name not in named_groups:
            yield Finding(name, None, f"group {group_name!r} has no grade cell"), None
    order = [group_name for group_name in points if group_name in named_groups]
    if [group_name for group_name in named_groups if group_name in points] != order:
        yield Finding(name, None, f"its grade cells are not in the order of the suite: {', '.join(order)}"), None
