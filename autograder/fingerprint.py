"""Digests the files of the course that a grading reads.

A submission that is graded twice with the same seed and the same digest gets the same result. `autograder grade
--resume` relies on this.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from autograder import layout

# Parts of the autograder that no grading reads.
NOT_READ = frozenset(
    {
        "bootstrap.py",
        "bundle.py",
        "cli",
        "cluster",
        "course",
        "doctor",
        "export",
        "feedback",
        "lms",
        "nbgrader",
        "notebook",
        "proof",
    }
)
# In a chapter's checks, for the proof only.
PROOF = frozenset(
    {"attack_payloads.py", "attacks.py", "mutants.snapshot.yaml", "mutants.yaml", "survivors.yaml", "variants"}
)
CHECKS_IMPORT = re.compile(r"\bautograder\.checks(?:\.| import )(ch\d\w+)")


def digest(assignment: str, reads: Iterable[str] = ()) -> str:
    """Return a digest of the files that a grading of the assignment reads, as 12 hexadecimal digits.

    Args:
        assignment: name of the assignment.
        reads: files and folders that its checks read beside their own, as paths in the course's folder.
    """
    found = hashlib.sha256()
    for path in files(assignment, reads):
        name = path.relative_to(layout.COURSE.root if path.is_relative_to(layout.COURSE.root) else layout.ROOT)
        found.update(f"{name}\0{path.stat().st_size}\0".encode() + path.read_bytes())
    return found.hexdigest()[:12]


def files(assignment: str, reads: Iterable[str] = ()) -> list[Path]:
    """Return the sorted paths of the files that a grading of the assignment reads; the arguments are as in `digest`."""
    course, home = layout.COURSE, layout.ROOT
    checks, chapter = course.root / course.checks, course.root / course.chapters / assignment
    shared = _below(home, (home / name for name in ("autograder", "sim", "assets/worlds")))
    suites = _below(course.root, (checks / name for name in _chapters(assignment, checks)))
    given = (chapter / f"{assignment}.ipynb", chapter / "ws" / "src")
    return sorted(
        {
            *(path for path in shared if _is_read(path.relative_to(home).parts)),
            *(path for path in suites if PROOF.isdisjoint(path.relative_to(checks).parts)),
            *_below(course.root, (*given, *(course.root / name for name in (course.worlds, *reads)))),
        }
    )


def _below(root: Path, tops: Iterable[Path]) -> Iterator[Path]:
    """Yield the files at and below some paths, without what tools left there."""
    for path in (path for top in tops for path in (top, *top.rglob("*")) if path.is_file()):
        parts = path.relative_to(root).parts
        if "__pycache__" not in parts and not any(part.startswith(".") for part in parts):
            yield path


def _chapters(assignment: str, checks: Path) -> set[str]:
    """Return the name of the folder of the assignment's checks, and of those from which they import."""
    pending = [f"ch{assignment}"]
    found: set[str] = set()
    while pending:
        name = pending.pop()
        if name not in found:
            found.add(name)
            sources = (
                path for path in (checks / name).rglob("*.py") if PROOF.isdisjoint(path.relative_to(checks).parts)
            )
            pending += [other for path in sources for other in CHECKS_IMPORT.findall(path.read_text(encoding="utf-8"))]
    return found


def _is_read(parts: tuple[str, ...]) -> bool:
    """Return whether each grading reads a file of the autograder or the simulator."""
    if parts[:2] == ("autograder", "checks"):
        return len(parts) == 3  # what a check is; the chapters stand in folders
    return parts[0] != "autograder" or parts[1] not in NOT_READ
