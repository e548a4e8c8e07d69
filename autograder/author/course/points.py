"""Compares the points of a notebook's grade cells with those of its hidden suite.

The suite has no points for the cells that a person grades.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial

from nbformat import NotebookNode

from autograder.author.course.cells import group, is_graded, is_manually_graded
from autograder.author.course.findings import Difference, Finding


def point_differences(name: str, notebook: NotebookNode, points: Mapping[str, float]) -> Iterator[Difference]:
    """Yield the grade cells whose points, group or place differ from the suite's, and the groups without a cell.

    Findings call the notebook by `name`. `points` are those of each group of its hidden suite.
    """
    seen: dict[str, None] = {}
    for cell in notebook.cells:
        if not is_graded(cell) or is_manually_graded(cell):
            continue
        named, has = group(cell), cell.metadata.nbgrader.get("points")
        if named is None or named not in points:
            message = f"stands for no group of the suite ({named!r}); its groups: {', '.join(points) or 'none'}"
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
            yield Finding(name, None, f"no grade cell stands for group {named!r}"), None
    order = [named for named in points if named in seen]
    if [named for named in seen if named in points] != order:
        yield Finding(name, None, f"its grade cells do not stand in the order of the suite: {', '.join(order)}"), None
