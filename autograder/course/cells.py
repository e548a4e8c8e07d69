"""Reads the course's own metadata of notebooks and cells.

The metadata of a cell that writes a file into the student's workspace:

    {"course": {"source": "my_robot_package/my_robot_package/nodes/robot_controller.py",
                "target": "ws/src/my_robot_package/my_robot_package/nodes/robot_controller.py",
                "hide": ["RobotController.control_loop"]}}

A file that is not Python, or has no functions, has `cut`: the lines around each part that the student writes:

    {"course": {"source": "square_dance/package.xml", "target": "ws/src/square_dance/package.xml",
                "cut": [["<export>", "</export>"]]}}

The metadata of a notebook names the files of the chapter's folder that are copies of the reference's:

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
from autograder.course.solution_markers import mark_functions, mark_lines, strip_licence


@dataclass(frozen=True)
class Origin:
    """The reference file that a cell copies.

    Attributes:
        source: path of the reference file, below `solutions/`.
        target: path of the file that the cell writes, below the chapter's folder.
        hide: qualified names of the functions whose bodies the student writes. It is empty where the student only runs
            the cell.
        cut: the lines before and after each part that the student writes, in a file without functions.
    """

    source: PurePosixPath
    target: PurePosixPath
    hide: tuple[str, ...]
    cut: tuple[tuple[str, str], ...] = ()

    def expected_text(self, solutions: Path) -> str:
        """Return the source that the cell must have.

        Raises:
            CourseError: the reference file is missing, or a function or line to hide is not in it.
        """
        text = strip_licence(read_solution(solutions, self.source))
        try:
            text = mark_functions(text, self.hide) if self.hide else text
            text = mark_lines(text, self.cut) if self.cut else text
        except CourseError as error:
            raise CourseError(f"{self.source}: {error}") from error
        return f"%%writefile {self.target}\n{text.rstrip()}"


def origin(cell: NotebookNode) -> Origin | None:
    """Return the reference file that a code cell copies, or None if it copies none.

    Raises:
        CourseError: the cell's metadata has not the form that this module's docstring shows.
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
    return Origin(relative_path(course["source"]), relative_path(course.get("target")), tuple(hide), pairs)


def _is_pair(value: object) -> bool:
    return isinstance(value, list) and len(value) == 2 and all(isinstance(line, str) for line in value)


def given_files(notebook: NotebookNode) -> dict[PurePosixPath, PurePosixPath]:
    """Return the chapter's files that are copies of reference files, as target to source.

    Raises:
        CourseError: the notebook's metadata has not the form that this module's docstring shows.
    """
    pairs = metadata(notebook).get("given", {})
    if not isinstance(pairs, Mapping):
        raise CourseError(f"\"given\" must map the chapter's files to the reference's, not be {pairs!r}")
    return {relative_path(target): relative_path(source) for target, source in pairs.items()}


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
    """Return whether nbgrader takes points from this cell."""
    return bool(cell.metadata.get("nbgrader", {}).get("grade"))


def is_manually_graded(cell: NotebookNode) -> bool:
    """Return whether students write in this cell and a person gives the points in nbgrader's formgrader."""
    return is_graded(cell) and is_solution(cell)


def is_solution(cell: NotebookNode) -> bool:
    """Return whether students write in this cell."""
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


def relative_path(path: object) -> PurePosixPath:
    """Return a relative path that stays inside its folder.

    Raises:
        CourseError: `path` is not a string, is empty or absolute, or leaves the folder.
    """
    if not isinstance(path, str) or not path:
        raise CourseError(f'"source" and "target" must be paths, not {path!r}')
    pure = PurePosixPath(path)
    if pure.is_absolute() or ".." in pure.parts:
        raise CourseError(f"{path!r} must stay inside its folder")
    return pure


def read_solution(solutions: Path, source: PurePosixPath) -> str:
    """Return the text of a reference file.

    Raises:
        CourseError: there is no such file.
    """
    path = solutions / source
    if not path.is_file():
        raise CourseError(f"the reference has no file {source}; look in {solutions.name}/")
    return path.read_text(encoding="utf-8")
