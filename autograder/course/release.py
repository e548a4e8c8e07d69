"""The students' bundle: released notebooks, the simulator, and the half of the autograder that students run.

No hidden check, no solution and no proof of the grader is in it. It is a project of its own: `make lab` works in it.
"""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

import nbformat

from autograder import layout
from autograder.course.forms import Form, in_form
from autograder.course.sync import Chapter, chapters
from autograder.exceptions import UsageError

# What a release is made of, beside the chapters; folders are taken whole.
PARTS = ("sim", "autograder", "assets/worlds", "pyproject.toml", "requirements.lock", "LICENSE", ".devcontainer")
FRONT = layout.ROOT / "assets" / "students"  # its README and its Makefile
# What students get of a chapter's checks.
SHARED = frozenset({"__init__.py", "conftest.py", "support", "visible"})
# The instructors' half, as paths in the bundle.
_PACKAGES = ("proof", "course", "nbgrader", "export", "feedback")
_VERBS = ("course", "demo", "export", "grade", "notebooks", "release", "verify")
WITHHELD = (*(f"autograder/{name}" for name in _PACKAGES), *(f"autograder/cli/{verb}.py" for verb in _VERBS))


def write_bundle(out: Path, names: tuple[str, ...] = ()) -> list[str]:
    """Write the students' bundle of these chapters, all without any, to the new folder `out`; return their names.

    Raises:
        UsageError: `out` exists, or there is no such chapter. Nothing is written then.
    """
    if out.exists():
        raise UsageError(f"{out} exists: give a folder that is still to be made")
    there = {chapter.assignment: chapter for chapter in chapters()}
    if unknown := set(names) - set(there):
        raise UsageError(f"there is no chapter {', '.join(sorted(unknown))}; there are: {', '.join(there)}")
    out.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=f".{out.name}-", dir=out.parent) as scratch:
        made = Path(scratch) / out.name
        chosen = [there[name] for name in names or there]
        _copy_parts(made)
        for chapter in chosen:
            _release(chapter, made / "chapters" / chapter.assignment)
        shutil.copytree(FRONT, made, dirs_exist_ok=True)
        made.rename(out)
    return [chapter.assignment for chapter in chosen]


def _copy_parts(made: Path) -> None:
    for part in PARTS:
        source, target = layout.ROOT / part, made / part
        if source.is_dir():
            shutil.copytree(source, target, ignore=layout.NOT_COPIED)
        else:
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(source, target)
    for withheld in WITHHELD:
        path = made / withheld
        shutil.rmtree(path) if path.is_dir() else path.unlink()
    for chapter in (made / layout.CHECKS.relative_to(layout.ROOT)).glob("ch*"):
        for path in chapter.iterdir():
            if path.name not in SHARED:
                shutil.rmtree(path) if path.is_dir() else path.unlink()


def _release(chapter: Chapter, folder: Path) -> None:
    shutil.copytree(chapter.folder, folder, ignore=layout.NOT_COPIED)
    nbformat.write(in_form(chapter.read(), Form.RELEASED), folder / chapter.path.name)
