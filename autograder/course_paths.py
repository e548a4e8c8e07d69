"""The course, and the paths of its folders and files.

A course is a folder with a `course.yaml`. These are its keys with their defaults; only the first two are required:

    name: my-course           its name for nbgrader
    title: My course          its name for people
    chapters: chapters        a folder for each assignment, with a notebook of the same name
    solutions: solutions      the reference, a source tree of packages
    checks: checks            a package for each assignment, `chID`, with its checks
    worlds: worlds            worlds, besides those that come with the simulator
    syllabus: syllabus.yaml   the topics and objectives that the course has to cover
    guide: checks.md          the page about hidden checks, which `autograder course tables` writes
    released: []              files that students get besides the released chapters, worlds and visible checks
    demo: ID                  the assignment that `autograder demo` shows; the first one by default

A process works on one course: the one around the autograder, or the one that the environment variable
AUTOGRADER_COURSE names, which `autograder --course FOLDER` sets. An autograder that was installed as a wheel has none
around it, and takes the one around the working folder. The course is read when it is first needed, never by an import.
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

ROOT = Path(__file__).resolve().parent.parent  # of the autograder and the simulator
COURSE_FILE = "course.yaml"
COURSE_VARIABLE = "AUTOGRADER_COURSE"
SHARED_WORLDS = ROOT / "assets" / "worlds"  # those that come with the simulator
# Ignores the files that tools create in a working folder; for `shutil.copytree`.
NOT_COPIED = shutil.ignore_patterns("build", "install", "log", "__pycache__", ".ipynb_checkpoints", ".*_cache")


@dataclass(frozen=True)
class Course:
    """A course, as its `course.yaml` describes it. Paths are below its folder, `root`."""

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
        """Return whether a path overlaps with files that students do not get. Files beside the chapters do not."""
        shown, chapters = (self.root / part).resolve(), (self.root / self.chapters).resolve()
        secrets = (chapters, *((self.root / name).resolve() for name in (self.solutions, self.checks, self.guide)))
        beside = shown.parent == chapters and shown.suffix != ""
        return not beside and any(shown.is_relative_to(s) or s.is_relative_to(shown) for s in secrets)

    @property
    def parts(self) -> tuple[str, ...]:
        """The paths of all parts of the course, including those that do not exist."""
        named = (self.chapters, self.solutions, self.checks, self.worlds, self.syllabus, self.guide)
        return (COURSE_FILE, *named, *self.released)


def _chosen() -> Path:
    """Return the folder of the course; around the working folder, where the autograder alone was installed."""
    around = (folder for folder in (ROOT, Path.cwd(), *Path.cwd().parents) if (folder / COURSE_FILE).is_file())
    return Path(os.environ.get(COURSE_VARIABLE) or next(around, ROOT)).resolve()


@cache
def course() -> Course:
    """Return the course of this process. Raises UsageError if none exists, or its file is invalid."""
    chosen = Course.read(_chosen())
    if chosen.root != ROOT:
        os.environ[COURSE_VARIABLE] = str(chosen.root)  # child processes may have another working folder
    return chosen


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
    """Return the folders with checks, which every sandbox hides: the course's, and those around the autograder."""
    around = ROOT / "autograder" / "checks"
    return tuple(sorted({*around.glob("ch*")} | ({_folder("checks")} - {around})))


def chapter(assignment: str) -> Path:
    """Return an assignment's source folder; a UsageError lists the existing ones."""
    folder = _folder("chapters") / assignment
    if "/" in assignment or not (folder / f"{assignment}.ipynb").is_file():
        raise UsageError(f"there is no assignment {assignment!r}; there are: {', '.join(assignments()) or 'none'}")
    return folder


def world_path(name: str) -> Path:
    """Return the path of a world of the course or of the simulator; a UsageError lists the existing ones."""
    there = {path.stem: path for folder in (SHARED_WORLDS, _folder("worlds")) for path in sorted(folder.glob("*.yaml"))}
    if name not in there:
        raise UsageError(f"there is no world {name!r}; there are: {', '.join(sorted(there))}")
    return there[name]


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
    """Return the file with the titles of an assignment's hidden checks that students may read."""
    return _folder("checks") / f"ch{assignment}" / "visible" / "hidden_titles.json"
