"""Writes the autograder that an instructor uploads to Gradescope: a zip with two scripts and the course.

Gradescope unpacks it to `/autograder/source`, runs `setup.sh` once and `run_autograder` for each submission:
https://gradescope-autograders.readthedocs.io/en/latest/specs/
"""

from __future__ import annotations

import os
import zipfile
from collections.abc import Iterator
from pathlib import Path

from autograder import layout
from autograder.checks import suites
from autograder.exceptions import UsageError
from autograder.sandbox import Tier

SCRIPTS = layout.ROOT / "assets" / "gradescope"
# What grading needs of the course, hidden checks and reference included.
COURSE = ("autograder", "sim", "assets", "chapters", "solutions", "pyproject.toml", "requirements.lock", "Makefile")
EXECUTABLE = 0o755 << 16


def write_autograder(assignment: str, out: Path, tier: Tier) -> None:
    """Write the zip that grades one assignment on Gradescope.

    Args:
        assignment: the assignment that it grades.
        out: the zip to write.
        tier: how students' code is kept apart there.

    Raises:
        UsageError: the assignment has no hidden checks, or `out` exists already.
    """
    if assignment not in suites.graded():
        raise UsageError(f"{assignment} has no hidden checks; there are: {', '.join(suites.graded())}")
    if out.exists():
        raise UsageError(f"{out} exists already: name a file that does not exist yet")
    with zipfile.ZipFile(out, "x", zipfile.ZIP_DEFLATED) as archive:
        for name in ("setup.sh", "run_autograder"):
            script = (SCRIPTS / name).read_text(encoding="utf-8")
            entry = zipfile.ZipInfo(name)
            entry.external_attr = EXECUTABLE
            archive.writestr(entry, script.replace("ASSIGNMENT", assignment).replace("ISOLATION", tier.value))
        for path in _course():
            archive.write(path, Path("course", path.relative_to(layout.ROOT)))


def _course() -> Iterator[Path]:
    for name in COURSE:
        start = layout.ROOT / name
        if start.is_file():
            yield start
        for folder, folders, files in os.walk(start):
            left_out = layout.NOT_COPIED(folder, [*folders, *files])
            folders[:] = sorted(set(folders) - left_out)
            yield from (Path(folder, file) for file in sorted(set(files) - left_out))
