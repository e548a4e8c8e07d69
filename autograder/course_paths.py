"""The course, and the paths of its folders and files.

A course is a folder with a `course.yaml`. These are its keys with their defaults; only the first two are required:

    name: my-course           its name in nbgrader
    title: My course          its title on pages
    chapters: chapters        a folder for each assignment, with a notebook of the same name
    solutions: solutions      the reference, a source tree of packages
    checks: checks            a package for each assignment, `chID`, with its checks
    worlds: worlds            worlds, besides those that come with the simulator
    syllabus: syllabus.yaml   the topics and objectives that the course has to cover
    guide: checks.md          the page about hidden checks, which `autograder course tables` writes
    released: []              files that students get besides the released chapters, worlds and visible checks
    demo: ID                  the assignment that `autograder demo` shows; the first one by default

A process works on one course. The environment variable AUTOGRADER_COURSE, which `autograder --course FOLDER` sets,
names its folder. Without this variable, the course is the clone that contains the autograder; an autograder that was
installed as a wheel uses the course that contains the working folder. `course.yaml` is read when it is first needed.
"""

from __future__ import annotations

import os
import shutil
from dataclasses import dataclass, fields
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from autograder.exceptions import UsageError

ROOT = Path(__file__).resolve().parent.parent  # the folder that contains the autograder and the simulator
COURSE_FILE = "course.yaml"
COURSE_VARIABLE = "AUTOGRADER_COURSE"
SHARED_WORLDS = ROOT / "assets" / "worlds"  # the worlds that come with the simulator
# For `shutil.copytree`: ignores the files that tools create in a working folder.
NOT_COPIED = shutil.ignore_patterns("build", "install", "log", "__pycache__", ".ipynb_checkpoints", ".*_cache")


@dataclass(frozen=True)
class Course:
    """A course, as its `course.yaml` describes it. Paths are relative to its folder, `root`."""

    root: Path
    name: str
    title: str
    chapters: str = "chapters"
    solutions: str = "solutions"
    checks: str = "checks"
    worlds: str = "worlds"
    syllabus: str = "syllabus.yaml"
    guide: str = "checks.md"
    released: tuple[str, ...] = ()
    demo: str = ""

    @classmethod
    def read(cls, root: Path) -> Course:
        """Read the course in a folder. Raises UsageError if the folder has no valid course.yaml."""
        path = root / COURSE_FILE
        try:
            data: Any = yaml.safe_load(path.read_text(encoding="utf-8"))
            course = cls(root, **{**data, "released": tuple(data.get("released", ()))})
        except OSError:
            raise UsageError(f"{root} is not a course: it has no {COURSE_FILE}; --course names another one") from None
        except (yaml.YAMLError, AttributeError, TypeError) as error:
            lines = ", ".join(field.name for field in fields(cls)[1:])
            raise UsageError(f"{path}: {error}; the lines of this file are {lines}") from None
        for part in course.parts:
            if not isinstance(part, str) or not (root / part).resolve().is_relative_to(root):
                raise UsageError(f"{path}: {part!r} is not a path in the course's folder")
        for part in filter(course.shows_answers, (course.worlds, *course.released)):
            raise UsageError(f"{path}: {part!r} goes to students, and would show them answers or hidden checks")
        return course

    def shows_answers(self, part: str) -> bool:
        """Return whether a path overlaps with files that students must not get.

        A file directly in the folder of chapters, such as a README, does not count as such a file.
        """
        path, chapters = (self.root / part).resolve(), (self.root / self.chapters).resolve()
        secret_paths = (chapters, *((self.root / name).resolve() for name in (self.solutions, self.checks, self.guide)))
        is_beside_chapters = path.parent == chapters and path.suffix != ""
        return not is_beside_chapters and any(
            path.is_relative_to(secret) or secret.is_relative_to(path) for secret in secret_paths
        )

    @property
    def parts(self) -> tuple[str, ...]:
        """The paths of all parts of the course, including those that do not exist."""
        named_parts = (self.chapters, self.solutions, self.checks, self.worlds, self.syllabus, self.guide)
        return (COURSE_FILE, *named_parts, *self.released)


def _course_folder() -> Path:
    """Return the folder of this process's course."""
    candidates = (folder for folder in (ROOT, Path.cwd(), *Path.cwd().parents) if (folder / COURSE_FILE).is_file())
    return Path(os.environ.get(COURSE_VARIABLE) or next(candidates, ROOT)).resolve()


@cache
def course() -> Course:
    """Return the course of this process. Raises UsageError if no course exists, or its `course.yaml` is invalid."""
    current_course = Course.read(_course_folder())
    if current_course.root != ROOT:
        os.environ[COURSE_VARIABLE] = str(current_course.root)  # child processes may have another working folder
    return current_course


def _folder(name: str) -> Path:
    return course().root / (".build" if name == "build" else getattr(course(), name))


CHAPTERS: Path
SOLUTIONS: Path
CHECKS: Path
WORLDS: Path
BUILD: Path


def __getattr__(name: str) -> Path:
    """Return the path of a folder of the course, such as `course_paths.CHAPTERS`."""
    if name not in ("CHAPTERS", "SOLUTIONS", "CHECKS", "WORLDS", "BUILD"):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return _folder(name.lower())


def check_folders() -> tuple[Path, ...]:
    """Return the folders with checks of the course and of the autograder itself, all of which every sandbox hides."""
    bundled_checks = ROOT / "autograder" / "checks"
    return tuple(sorted({*bundled_checks.glob("ch*")} | ({_folder("checks")} - {bundled_checks})))


def chapter(assignment: str) -> Path:
    """Return an assignment's source folder. Raises UsageError if the assignment does not exist."""
    folder = _folder("chapters") / assignment
    if "/" in assignment or not (folder / f"{assignment}.ipynb").is_file():
        raise UsageError(f"there is no assignment {assignment!r}; there are: {', '.join(assignments()) or 'none'}")
    return folder


def world_path(name: str) -> Path:
    """Return the path of a world of the course or the simulator. Raises UsageError if the world does not exist."""
    worlds = {
        path.stem: path for folder in (SHARED_WORLDS, _folder("worlds")) for path in sorted(folder.glob("*.yaml"))
    }
    if name not in worlds:
        raise UsageError(f"there is no world {name!r}; there are: {', '.join(sorted(worlds))}")
    return worlds[name]


def solution_path(package: str) -> Path:
    """Return the folder of a package of the reference."""
    return _folder("solutions") / package


def assignments() -> list[str]:
    """Return the names of the course's assignments, in order."""
    return sorted(path.parent.name for path in _folder("chapters").glob("*/*.ipynb") if path.stem == path.parent.name)


def source_notebook(assignment: str) -> Path:
    """Return the path of an assignment's source notebook. Raises UsageError as `chapter` does."""
    return chapter(assignment) / f"{assignment}.ipynb"


def hidden_titles(assignment: str) -> Path:
    """Return the path of the file with the titles of an assignment's hidden checks, which students may read."""
    return _folder("checks") / f"ch{assignment}" / "visible" / "hidden_titles.json"
