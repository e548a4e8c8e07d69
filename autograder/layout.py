"""Paths of the course's folders and files."""

from __future__ import annotations

import shutil
from pathlib import Path

from autograder.exceptions import UsageError

ROOT = Path(__file__).resolve().parent.parent
CHAPTERS = ROOT / "chapters"
SOLUTIONS = ROOT / "solutions"
CHECKS = ROOT / "autograder" / "checks"
WORLDS = ROOT / "assets" / "worlds"
BUILD = ROOT / ".build"
# Ignores the files that tools create in a working folder; for `shutil.copytree`.
NOT_COPIED = shutil.ignore_patterns("build", "install", "log", "__pycache__", ".ipynb_checkpoints", ".*_cache")


def check_folders() -> tuple[Path, ...]:
    """Return the folders of all chapters' checks, which every sandbox hides."""
    return tuple(sorted(CHECKS.glob("ch*")))


def chapter(assignment: str) -> Path:
    """Return an assignment's source folder; a UsageError lists the existing ones."""
    folder = CHAPTERS / assignment
    if "/" in assignment or not (folder / f"{assignment}.ipynb").is_file():
        raise UsageError(f"there is no assignment {assignment!r}; there are: {', '.join(assignments()) or 'none'}")
    return folder


def world(name: str) -> Path:
    """Return the path of a world of the course; a UsageError lists the existing ones."""
    path = WORLDS / f"{name}.yaml"
    if not path.is_file():
        there = ", ".join(sorted(file.stem for file in WORLDS.glob("*.yaml")))
        raise UsageError(f"there is no world {name!r}; there are: {there}")
    return path


def assignments() -> list[str]:
    """Return the names of the course's assignments, in order."""
    return sorted(path.parent.name for path in CHAPTERS.glob("*/*.ipynb") if path.stem == path.parent.name)


def source_notebook(assignment: str) -> Path:
    """Return the path of an assignment's source notebook. Raises UsageError as `chapter` does."""
    return chapter(assignment) / f"{assignment}.ipynb"


def judged_later(assignment: str) -> Path:
    """Return the file with the titles of an assignment's hidden checks that students may read."""
    return CHECKS / f"ch{assignment}" / "visible" / "judged_later.json"
