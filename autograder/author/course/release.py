"""Writes a student release: released notebooks, the simulator, and the part of the autograder that students run.

It contains no hidden checks, no solutions and no verification. It is a self-contained project in which `make lab`
works.
"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterable
from datetime import datetime, timezone
from pathlib import Path

import nbformat

from autograder import course_paths
from autograder.author.course.forms import Form, in_form
from autograder.author.course.sync import Chapter, chapters
from autograder.author.student_release import write_manifest
from autograder.exceptions import UsageError

# Files and folders of this repository that a release contains in addition to the course.
IMAGE = (".binder", ".devcontainer")
COPIED = ("sim", "autograder", "assets/worlds", "pyproject.toml", "requirements.lock", "LICENSE", *IMAGE)
STUDENT_FILES = course_paths.ROOT / "assets" / "students"  # the README and the Makefile of a student release
# The parts of a chapter's folder of checks that students get.
STUDENT_CHECKS = frozenset({"__init__.py", "conftest.py", "support", "visible"})
# The modules of `cli` that students get: the commands for students, and what these import.
STUDENT_CLI = frozenset({"__init__.py", "options.py", "terminal.py", "check.py", "doctor.py", "ros.py", "update.py"})
# The folders and modules that only instructors get.
INSTRUCTOR_PARTS = ("author/course", "author/verification", "checking/attacks.py", "grade/cluster", "lms", "report")


def write_release(out: Path, names: tuple[str, ...] = (), newest: str = "") -> list[str]:
    """Write a student release of these chapters (all by default) to the new folder `out`, and return their names.

    Its version is the current time. `newest` is the folder where students' machines find the newest release. If `out`
    exists, or one of the chapters does not, it writes nothing and raises UsageError.
    """
    if out.exists():
        raise UsageError(f"{out} already exists: choose a new folder")
    selected_chapters = chapters(names)
    out.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=f".{out.name}-", dir=out.parent) as scratch:
        release = Path(scratch) / out.name
        copy_tool(COPIED, release)
        _remove_instructor_parts(release)
        copy_course((course_paths.COURSE_FILE, course_paths.course().worlds, *course_paths.course().released), release)
        checks = [path for path in course_paths.CHECKS.glob("ch*/*") if path.name in STUDENT_CHECKS]
        copy_course((str(path.relative_to(course_paths.course().root)) for path in checks), release)
        for chapter in selected_chapters:
            write_released(chapter, release / course_paths.course().chapters / chapter.assignment)
        shutil.copytree(STUDENT_FILES, release, dirs_exist_ok=True)
        readme = (STUDENT_FILES / "README.md").read_text(encoding="utf-8")
        readme = readme.replace("TITLE", course_paths.course().title).replace("FIRST", selected_chapters[0].assignment)
        (release / "README.md").write_text(readme, encoding="utf-8")
        write_manifest(release, datetime.now(timezone.utc).isoformat(timespec="seconds"), newest)
        release.rename(out)
    return [chapter.assignment for chapter in selected_chapters]


def copy_tool(parts: Iterable[str], folder: Path) -> None:
    """Copy files and folders of the autograder's repository to `folder`, without the checks of chapters."""
    _copy(course_paths.ROOT, parts, folder)
    for chapter in (folder / "autograder" / "checks").glob("ch*"):
        shutil.rmtree(chapter)


def copy_course(parts: Iterable[str], folder: Path) -> None:
    """Copy files and folders of the course to `folder`, if they exist. `parts` are paths relative to the course."""
    _copy(course_paths.course().root, (part for part in parts if (course_paths.course().root / part).exists()), folder)


def _copy(root: Path, parts: Iterable[str], folder: Path) -> None:
    """Copy parts of `root` without files that tools have left behind."""
    for part in parts:
        source, target = root / part, folder / part
        if source.is_dir():
            shutil.copytree(source, target, ignore=course_paths.NOT_COPIED, dirs_exist_ok=True)
        else:
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(source, target)


def _remove_instructor_parts(release: Path) -> None:
    tool = release / "autograder"
    for path in (tool / name for name in INSTRUCTOR_PARTS):
        shutil.rmtree(path) if path.is_dir() else path.unlink()
    for module in (tool / "cli").iterdir():
        if module.name not in STUDENT_CLI:
            module.unlink()


def write_released(chapter: Chapter, folder: Path) -> None:
    """Write a chapter's folder as students get it."""
    shutil.copytree(chapter.folder, folder, ignore=course_paths.NOT_COPIED)
    nbformat.write(in_form(chapter.read(), Form.RELEASED), folder / chapter.notebook_path.name)
