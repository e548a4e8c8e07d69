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
    seen: dict[str, None] = {}
    for cell in notebook.cells:
        if not is_graded(cell) or is_manually_graded(cell):
            continue
        named, has = group(cell), cell.metadata.nbgrader.get("points")
        if named is None or named not in points:
            message = f"names the unknown group {named!r}; the suite's groups are {', '.join(points) or 'none'}"
            yield Finding(name, cell.id, message), None
        elif named in seen:
            yield Finding(name, cell.id, f"is the second cell of group {named!r}"), None
        elif has != points[named]:
            message = f"has {has} points, but the checks of {named!r} have {points[named]:g}"
            set_points = partial(cell.metadata.nbgrader.__setitem__, "points", points[named])
            yield Finding(name, cell.id, message), set_points
        seen.setdefault(str(named))
    for named in points:
        if named not in seen:
            yield Finding(name, None, f"group {named!r} has no grade cell"), None
    order = [named for named in points if named in seen]
    if [named for named in seen if named in points] != order:
        yield Finding(name, None, f"its grade cells are not in the order of the suite: {', '.join(order)}"), None
