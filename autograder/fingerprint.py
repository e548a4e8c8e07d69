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
    shared = [root / name for name in ("autograder", "sim", "assets/worlds", *reads)]
    own = [*_check_folders(assignment, root), chapter / f"{assignment}.ipynb", chapter / "ws" / "src"]
    return sorted({path for top in shared + own for path in _files_below(top, root / "autograder")})


def _check_folders(assignment: str, root: Path) -> set[Path]:
    """Return the folder of the assignment's checks, and those of the chapters from which they import."""
    home = root / "autograder" / "checks"
    pending = [home / f"ch{assignment}"]
    found: set[Path] = set()
    while pending:
        folder = pending.pop()
        if folder not in found:
            found.add(folder)
            texts = (path.read_text(encoding="utf-8") for path in folder.rglob("*.py") if not _is_proof(path, home))
            pending += [home / name for text in texts for name in CHECKS_IMPORT.findall(text)]
    return found


def _is_proof(path: Path, home: Path) -> bool:
    """Return whether a path below `home`, the folder of all checks, is for the proof only."""
    return not PROOF.isdisjoint(path.relative_to(home).parts)


def _files_below(path: Path, grader: Path) -> Iterator[Path]:
    """Yield a file, or the files of a folder that a grading reads, without the checks of chapters."""
    if path.is_file():
        yield path
    for child in path.iterdir() if path.is_dir() else ():
        not_read = path == grader and child.name in NOT_READ
        home = grader / "checks"
        proof = child.is_relative_to(home) and _is_proof(child, home)
        checks = path == home and CHAPTER.match(child.name)
        if not (not_read or proof or checks or child.name.startswith(".") or child.name == "__pycache__"):
            yield from _files_below(child, grader)
