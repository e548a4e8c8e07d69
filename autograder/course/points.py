"""Compares the points of a notebook's grade cells with those of its hidden suite, and sets them.

The suite has no points for the cells that a person grades.
"""

from __future__ import annotations

from collections.abc import Mapping

from nbformat import NotebookNode

from autograder.course.cells import group, is_graded, is_manually_graded
from autograder.course.exceptions import CourseError
from autograder.course.findings import Finding


def wrong_points(name: str, notebook: NotebookNode, points: Mapping[str, float]) -> list[Finding]:
    """Return the grade cells whose points or group differ from the suite's, and the groups without a cell.

    Args:
        name: the notebook's file name, for the findings.
        notebook: the notebook to compare.
        points: the points of each group of its hidden suite.
    """
    return [finding for finding, _ in _wrong(name, notebook, points)]


def set_points(name: str, notebook: NotebookNode, points: Mapping[str, float]) -> bool:
    """Set the points of each grade cell to the sum of its group, in place.

    Args:
        name: the notebook's file name, for the errors.
        notebook: the notebook to change.
        points: the points of each group of its hidden suite.

    Returns:
        Whether the points of a cell changed.

    Raises:
        CourseError: a cell names no group of the suite, two name one group, or a group has no cell.
    """
    wrong = _wrong(name, notebook, points)
    for finding, cell in wrong:
        if cell is None:
            raise CourseError(str(finding))
    for _, cell in wrong:
        if cell is not None:
            cell.metadata.nbgrader["points"] = points[str(group(cell))]
    return bool(wrong)


def _wrong(name: str, notebook: NotebookNode, points: Mapping[str, float]) -> list[tuple[Finding, NotebookNode | None]]:
    """Return findings. A finding has its cell if setting the points of that cell is the remedy, and None otherwise."""
    wrong: list[tuple[Finding, NotebookNode | None]] = []
    seen: set[str] = set()
    for cell in notebook.cells:
        if not is_graded(cell) or is_manually_graded(cell):
            continue
        named = group(cell)
        if named is None or named not in points:
            message = f"stands for no group of the suite ({named!r}); its groups: {', '.join(points) or 'none'}"
            wrong.append((Finding(name, cell.id, message), None))
        elif named in seen:
            wrong.append((Finding(name, cell.id, f"is the second cell of group {named!r}"), None))
        elif cell.metadata.nbgrader.get("points") != points[named]:
            has = cell.metadata.nbgrader.get("points")
            message = f"has {has} points, but the checks of {named!r} have {points[named]:g}"
            wrong.append((Finding(name, cell.id, message), cell))
        seen.add(str(named))
    missing = [named for named in points if named not in seen]
    wrong += [(Finding(name, None, f"no grade cell stands for group {named!r}"), None) for named in missing]
    return wrong
