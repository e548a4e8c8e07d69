"""Digests the files of the course that a grading reads.

A submission that is graded twice with the same seed and the same digest gets the same result. `autograder grade
--resume` relies on this.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable
from pathlib import Path

from autograder import layout

# Parts of the autograder that no grading reads.
NOT_READ = frozenset(
    {
        "bootstrap.py",
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
PROOF = frozenset({"mutants.yaml", "survivors.yaml", "variants"})  # in a chapter's checks, for the proof only
CHAPTER = re.compile(r"ch\d\d_")
CHECKS_IMPORT = re.compile(r"\bautograder\.checks(?:\.| import )(ch\d\d_\w+)")


def digest(assignment: str, reads: Iterable[str] = (), root: Path = layout.ROOT) -> str:
    """Return a digest of the files that a grading of the assignment reads, as 12 hexadecimal digits.

    Args:
        assignment: name of the assignment.
        reads: files and folders that its checks read beside their own, as paths below `root`.
        root: folder of the course.
    """
    found = hashlib.sha256()
    for path in files(assignment, reads, root):
        found.update(f"{path.relative_to(root)}\0{path.stat().st_size}\0".encode() + path.read_bytes())
    return found.hexdigest()[:12]


def files(assignment: str, reads: Iterable[str] = (), root: Path = layout.ROOT) -> list[Path]:
    """Return the sorted paths of the files that a grading of the assignment reads; the arguments are as in `digest`."""
    chapter = root / "chapters" / assignment
    tops = [root / name for name in ("autograder", "sim", "assets/worlds", *reads)]
    tops += [chapter / f"{assignment}.ipynb", chapter / "ws" / "src"]
    chapters = _chapters(assignment, root / "autograder" / "checks")
    found = {path for top in tops for path in (top, *top.rglob("*")) if path.is_file()}
    return sorted(path for path in found if _is_read(path.relative_to(root).parts, chapters))


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


def _is_read(parts: tuple[str, ...], chapters: set[str]) -> bool:
    """Return whether a grading reads a file by its path below the root, if these chapters' checks are read."""
    if "__pycache__" in parts or any(part.startswith(".") for part in parts):
        return False
    if parts[:2] == ("autograder", "checks"):
        return PROOF.isdisjoint(parts) and (parts[2] in chapters or not CHAPTER.match(parts[2]))
    return parts[0] != "autograder" or parts[1] not in NOT_READ
