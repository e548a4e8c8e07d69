"""Writes the autograder that an instructor uploads to Gradescope: a zip with two scripts and the course.

Gradescope unpacks it to `/autograder/source`, runs `setup.sh` once, and runs `run_autograder` for each submission:
https://gradescope-autograders.readthedocs.io/en/latest/specs/
"""

from __future__ import annotations

import shutil
import tempfile
import zipfile
from pathlib import Path

from autograder import course_paths
from autograder.author.course.release import copy_course, copy_tool
from autograder.exceptions import UsageError
from autograder.run.sandbox import Isolation
from autograder.suite import suites

SCRIPTS = course_paths.ROOT / "assets" / "gradescope"  # the zip preserves their executable bits
# The parts that grading requires in addition to the course.
COPIED = ("autograder", "sim", "assets", "pyproject.toml", "requirements.lock", "Makefile")


def write_autograder(assignment: str, out: Path, isolation: Isolation) -> None:
    """Write the zip `out`, which grades an assignment on Gradescope with the isolation level `isolation`.

    Raises UsageError if the assignment has no hidden checks, or if `out` already exists.
    """
    suites.hidden(assignment)
    if out.exists():
        raise UsageError(f"{out} already exists: choose a new file name")
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        copy_tool(COPIED, folder / "course")
        copy_course(course_paths.course().parts, folder / "course")
        for script in SCRIPTS.iterdir():
            text = script.read_text(encoding="utf-8").replace("ASSIGNMENT", assignment)
            shutil.copy2(script, folder)
            (folder / script.name).write_text(text.replace("ISOLATION", isolation.value), encoding="utf-8")
        with zipfile.ZipFile(out, "x", zipfile.ZIP_DEFLATED) as archive:
            for path in sorted(folder.rglob("*")):
                archive.write(path, path.relative_to(folder))
