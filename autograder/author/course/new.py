"""Creates a new chapter or a new course from the templates in `assets/new`.

A new chapter is small but complete: a notebook, requirements, a reference, visible and hidden checks, mutants and a
variant. It passes verification. Its author adapts it step by step.
"""

from __future__ import annotations

import importlib
import re
from collections.abc import Mapping
from pathlib import Path

from autograder import course_paths
from autograder.author.course.package_names import is_package_name, owner_of
from autograder.author.course.sync import Chapter, sync_chapter
from autograder.author.course.tables import titles_of
from autograder.author.course.workload import effort, time_sentence
from autograder.exceptions import UsageError

TEMPLATES = course_paths.ROOT / "assets" / "new"
NAME = re.compile(r"\d\d_(.+)")
OBJECTIVES = "objectives:\n"  # the line of a syllabus below which its objectives are listed
NODE = "nearest"  # the default name of a new chapter's node
# The classes that the reference of a new chapter imports.
IMPORTED_CLASSES = {"Node", "LaserScan", "Float32", "ExternalShutdownException"}


def write_chapter(assignment: str, package: str = "", node: str = NODE) -> tuple[Path, ...]:
    """Write a chapter of this name into the course, and return its folders and the syllabus, to which it is added.

    The folders are those of the notebook, the checks and the reference.

    Args:
        assignment: two digits and a name, such as `10_mapping`.
        package: the name of the students' package; by default the chapter's name without its number.
        node: the name of the package's node, of its executable and of its module.

    Raises:
        UsageError: a name is invalid or taken, or one of the folders exists. In that case nothing is written.
    """
    match = NAME.fullmatch(assignment)
    if match is None or not is_package_name(match[1]):
        raise UsageError(f"{assignment!r} is not a chapter name: use two digits and a name, such as 10_mapping")
    title = match[1].replace("_", " ").capitalize()
    package = package or match[1]
    _require_free("package", package, f"autograder new chapter {assignment} --package my_{match[1]}")
    _require_free("node", node, f"autograder new chapter {assignment} --node my_{node}")
    node_class = node.title().replace("_", "")
    if node_class in IMPORTED_CLASSES:
        raise UsageError(
            f"a node {node!r} would have the class {node_class}, which its module also imports. Choose another name"
        )
    folders = (
        course_paths.CHAPTERS / assignment,
        course_paths.CHECKS / f"ch{assignment}",
        course_paths.SOLUTIONS / package,
    )
    placeholders = {
        "NEW_CHAPTER": assignment,
        "NEW_PACKAGE": package,
        "NEW_NODE": node,
        "NEW_CLASS": node_class,
        "NEW_TITLE": title,
    }
    _require_new(*folders)
    for part, folder in zip(("chapter", "checks", "solution"), folders, strict=True):
        _write(TEMPLATES / "chapter" / part, folder, placeholders)
    syllabus = course_paths.course().root / course_paths.course().syllabus
    text = syllabus.read_text(encoding="utf-8") if syllabus.is_file() else OBJECTIVES
    objective = f"{OBJECTIVES}  {package}: {title}\n"
    syllabus.write_text(text.replace(OBJECTIVES, objective, 1), encoding="utf-8")
    _complete(Chapter(folders[0]))
    return *folders, syllabus


def write_course(folder: Path) -> None:
    """Create a course without chapters in a new folder, with the files that a repository needs.

    Raises UsageError if the folder exists.
    """
    _require_new(folder)
    title = folder.name.replace("_", " ").replace("-", " ").capitalize()
    # Git would apply a .gitignore among the templates to this repository.
    placeholders = {"NEW_COURSE": folder.name, "NEW_TITLE": title, "NEW_DOT_": "."}
    _write(TEMPLATES / "course", folder, placeholders)


def _require_free(kind: str, name: str, alternative: str) -> None:
    if not is_package_name(name):
        raise UsageError(f"{name!r} is not a {kind} name: use lower-case letters, digits and single underscores")
    if owner := owner_of(name):
        raise UsageError(f"a {kind} cannot be called {name!r}, which is {owner}. Choose another name: {alternative}")


def _require_new(*folders: Path) -> None:
    for folder in folders:
        if folder.exists():
            raise UsageError(f"{folder} already exists: choose another name")


def _write(template: Path, folder: Path, placeholders: Mapping[str, str]) -> None:
    """Copy a folder of text files, and replace the placeholders in their names and texts by values."""

    def substitute(text: str) -> str:
        for placeholder, value in placeholders.items():
            text = text.replace(placeholder, value)
        return text

    for source in sorted(path for path in template.rglob("*") if path.is_file() and "__pycache__" not in path.parts):
        target = folder / substitute(str(source.relative_to(template)))
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(substitute(source.read_text(encoding="utf-8")), encoding="utf-8")


def _complete(chapter: Chapter) -> None:
    """Write the generated parts of a chapter: copies of the reference, points, minutes and titles of hidden checks."""
    importlib.invalidate_caches()  # Python may have cached the folder without the new checks
    sync_chapter(chapter)
    notebook = chapter.read()
    first = notebook.cells[0]
    first.source = first.source.replace("NEW_MINUTES", time_sentence(effort(notebook)))
    chapter.write(notebook)
    course_paths.hidden_titles(chapter.assignment).write_text(titles_of(chapter.assignment), encoding="utf-8")
