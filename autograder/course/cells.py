"""What a notebook says about where its cells and files come from.

In a cell's metadata, for a file that the cell writes into the student's workspace:

    {"course": {"source": "my_robot_package/my_robot_package/nodes/robot_controller.py",
                "target": "ws/src/my_robot_package/my_robot_package/nodes/robot_controller.py",
                "hide": ["RobotController.control_loop"]}}

For a file that is not Python, or has no functions, `cut` names the lines around what the student writes:

    {"course": {"source": "square_dance/package.xml", "target": "ws/src/square_dance/package.xml",
                "cut": [["<export>", "</export>"]]}}

In the notebook's metadata, for files of the chapter's folder that equal the reference's:

    {"course": {"given": {"ws/src/my_robot_package/setup.cfg": "my_robot_package/setup.cfg"}}}

Sources are paths in `solutions/`, targets are paths in the chapter's folder.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any

from nbformat import NotebookNode

from autograder.course.exceptions import CourseError
from autograder.course.solution_markers import with_cuts, with_holes, without_licence


@dataclass(frozen=True)
class Origin:
    """Where a cell's text comes from.

    Attributes:
        source: the reference's file, in `solutions/`.
        target: the file that the cell writes, in the chapter's folder.
        hide: functions whose bodies the student writes; none for a cell that only shows and writes a file.
        cut: the lines before and after each part that the student writes, in a file without functions.
    """

    source: PurePosixPath
    target: PurePosixPath
    hide: tuple[str, ...]
    cut: tuple[tuple[str, str], ...] = ()

    def text(self, solutions: Path) -> str:
        """Return what the cell must hold.

        Raises:
            CourseError: the reference's file is missing, or what is to be hidden is not in it.
        """
        text = without_licence(read(solutions, self.source))
        try:
            text = with_holes(text, self.hide) if self.hide else text
            text = with_cuts(text, self.cut) if self.cut else text
        except CourseError as error:
            raise CourseError(f"{self.source}: {error}") from error
        return f"%%writefile {self.target}\n{text.rstrip()}"


def origin(cell: NotebookNode) -> Origin | None:
    """Return where a code cell comes from, or None when it was written in the notebook.

    Raises:
        CourseError: its metadata is not as this module's docstring says.
    """
    course = metadata(cell)
    if "source" not in course:
        return None
    hide = course.get("hide", [])
    if not isinstance(hide, list) or not all(isinstance(name, str) for name in hide):
        raise CourseError(f'"hide" must be a list of function names, not {hide!r}')
    cut = course.get("cut", [])
    if not isinstance(cut, list) or not all(_is_pair(pair) for pair in cut):
        raise CourseError(f'"cut" must be a list of pairs of lines, not {cut!r}')
    if hide and cut:
        raise CourseError('a cell hides functions by "hide" or lines by "cut", not both')
    pairs = tuple((str(before), str(after)) for before, after in cut)
    return Origin(inside(course["source"]), inside(course.get("target")), tuple(hide), pairs)


def _is_pair(value: object) -> bool:
    return isinstance(value, list) and len(value) == 2 and all(isinstance(line, str) for line in value)


def given(notebook: NotebookNode) -> dict[PurePosixPath, PurePosixPath]:
    """Return the chapter's files that equal the reference's: target to source.

    Raises:
        CourseError: the metadata is not as this module's docstring says.
    """
    pairs = metadata(notebook).get("given", {})
    if not isinstance(pairs, Mapping):
        raise CourseError(f"\"given\" must map the chapter's files to the reference's, not be {pairs!r}")
    return {inside(target): inside(source) for target, source in pairs.items()}


def group(cell: NotebookNode) -> str | None:
    """Return the group of checks that a grade cell stands for, or None.

    Raises:
        CourseError: the group is not a string.
    """
    found = metadata(cell).get("group")
    if found is not None and not isinstance(found, str):
        raise CourseError(f'"group" must name a group of checks, not be {found!r}')
    return found


def is_graded(cell: NotebookNode) -> bool:
    """Say whether nbgrader takes points from this cell."""
    return bool(cell.metadata.get("nbgrader", {}).get("grade"))


def is_manual(cell: NotebookNode) -> bool:
    """Say whether students write in this cell and a person gives the points, in nbgrader's formgrader."""
    return is_graded(cell) and is_solution(cell)


def is_solution(cell: NotebookNode) -> bool:
    """Say whether students write in this cell."""
    return bool(cell.metadata.get("nbgrader", {}).get("solution"))


def metadata(node: NotebookNode) -> Mapping[str, Any]:
    """Return the `course` part of a cell's or a notebook's metadata.

    Raises:
        CourseError: it is not a mapping.
    """
    course = node.metadata.get("course", {})
    if not isinstance(course, Mapping):
        raise CourseError(f'the metadata\'s "course" must be a mapping, not {course!r}')
    return course


def inside(path: object) -> PurePosixPath:
    """Return a path that stays inside its folder.

    Raises:
        CourseError: it is no path, or an absolute one, or one that leaves the folder.
    """
    if not isinstance(path, str) or not path:
        raise CourseError(f'"source" and "target" must be paths, not {path!r}')
    pure = PurePosixPath(path)
    if pure.is_absolute() or ".." in pure.parts:
        raise CourseError(f"{path!r} must stay inside its folder")
    return pure


def read(solutions: Path, source: PurePosixPath) -> str:
    """Return the text of one of the reference's files.

    Raises:
        CourseError: there is no such file.
    """
    path = solutions / source
    if not path.is_file():
        raise CourseError(f"the reference has no file {source}; look in {solutions.name}/")
    return path.read_text(encoding="utf-8")
