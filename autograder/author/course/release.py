"""Writes the students' bundle: released notebooks, the simulator, and the part of the autograder that students run.

The bundle holds no hidden check, no solution and no proof of the grader. It is a project of its own: `make lab` works
in it.
"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterable
from datetime import datetime, timezone
from pathlib import Path

import nbformat

from autograder import layout
from autograder.author.bundle import write_manifest
from autograder.author.course.forms import Form, in_form
from autograder.author.course.sync import Chapter, chapters
from autograder.exceptions import UsageError

# Files and whole folders that are copied beside the course.
IMAGE = (".binder", ".devcontainer")
COPIED = ("sim", "autograder", "assets/worlds", "pyproject.toml", "requirements.lock", "LICENSE", *IMAGE)
STUDENT_FILES = layout.ROOT / "assets" / "students"  # the README and the Makefile of the bundle
# The entries of a chapter's folder of checks that students get.
STUDENT_CHECKS = frozenset({"__init__.py", "conftest.py", "support", "visible"})
# The modules of the command line that students get: their verbs, and what these need.
STUDENT_CLI = frozenset({"__init__.py", "options.py", "terminal.py", "check.py", "doctor.py", "ros.py", "update.py"})
WITHHELD = ("author/course", "author/verification", "grade/cluster", "lms", "report")  # parts for instructors only


def write_bundle(out: Path, names: tuple[str, ...] = (), newest: str = "") -> list[str]:
    """Write the students' bundle of these chapters (all by default) to the new folder `out`; return their names.

    Its version is the present time. `newest` is the folder where students' machines find the newest release. Raises
    UsageError if `out` exists or a chapter does not. Nothing is written then.
    """
    if out.exists():
        raise UsageError(f"{out} exists already: name a folder that does not exist yet")
    chosen = chapters(names)
    out.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=f".{out.name}-", dir=out.parent) as scratch:
        bundle = Path(scratch) / out.name
        copy_tool(COPIED, bundle)
        _withhold(bundle)
        copy_course((layout.COURSE_FILE, layout.course().worlds, *layout.course().released), bundle)
        checks = [path for path in layout.CHECKS.glob("ch*/*") if path.name in STUDENT_CHECKS]
        copy_course((str(path.relative_to(layout.course().root)) for path in checks), bundle)
        for chapter in chosen:
            write_released(chapter, bundle / layout.course().chapters / chapter.assignment)
        shutil.copytree(STUDENT_FILES, bundle, dirs_exist_ok=True)
        readme = (STUDENT_FILES / "README.md").read_text(encoding="utf-8")
        readme = readme.replace("TITLE", layout.course().title).replace("FIRST", chosen[0].assignment)
        (bundle / "README.md").write_text(readme, encoding="utf-8")
        write_manifest(bundle, datetime.now(timezone.utc).isoformat(timespec="seconds"), newest)
        bundle.rename(out)
    return [chapter.assignment for chapter in chosen]


def copy_tool(parts: Iterable[str], folder: Path) -> None:
    """Copy files and folders that lie around the autograder, without any course's checks, to `folder`."""
    _copy(layout.ROOT, parts, folder)
    for chapter in (folder / "autograder" / "checks").glob("ch*"):
        shutil.rmtree(chapter)


def copy_course(parts: Iterable[str], folder: Path) -> None:
    """Copy those files and folders of the course that it has, by their paths in it, to `folder`."""
    _copy(layout.course().root, (part for part in parts if (layout.course().root / part).exists()), folder)


def _copy(root: Path, parts: Iterable[str], folder: Path) -> None:
    """Copy what lies below `root`, without what tools left behind."""
    for part in parts:
        source, target = root / part, folder / part
        if source.is_dir():
            shutil.copytree(source, target, ignore=layout.NOT_COPIED, dirs_exist_ok=True)
        else:
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(source, target)


def _withhold(bundle: Path) -> None:
    tool = bundle / "autograder"
    for name in WITHHELD:
        shutil.rmtree(tool / name)
    for module in (tool / "cli").iterdir():
        if module.name not in STUDENT_CLI:
            module.unlink()


def write_released(chapter: Chapter, folder: Path) -> None:
    """Write the folder of a chapter as students get it."""
    shutil.copytree(chapter.folder, folder, ignore=layout.NOT_COPIED)
    nbformat.write(in_form(chapter.read(), Form.RELEASED), folder / chapter.notebook_path.name)
