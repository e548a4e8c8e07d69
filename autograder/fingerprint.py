"""What a grading depends on: one digest of every file of the course that it reads.

A submission graded twice with one seed and one digest gets one result; `autograder grade --resume` relies on it.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from autograder import layout

# Parts of the autograder that no grading asks.
APART = frozenset({"bootstrap.py", "cli", "course", "doctor", "export", "feedback", "nbgrader", "notebook", "proof"})
PROOF = frozenset({"mutants.yaml", "survivors.yaml", "variants"})  # in a chapter's checks: what judges them
CHAPTER = re.compile(r"ch\d\d_")
MENTION = re.compile(r"\bautograder\.checks(?:\.| import )(ch\d\d_\w+)")


def digest(assignment: str, reads: Iterable[str] = (), root: Path = layout.ROOT) -> str:
    """Return a short digest that changes whenever a file changes that a grading of the assignment reads.

    Args:
        assignment: what is graded.
        reads: files and folders that its checks read besides their own packages, by their paths below `root`.
        root: the course's folder.
    """
    found = hashlib.sha256()
    for path in files(assignment, reads, root):
        found.update(f"{path.relative_to(root)}\0{path.stat().st_size}\0".encode() + path.read_bytes())
    return found.hexdigest()[:12]


def files(assignment: str, reads: Iterable[str] = (), root: Path = layout.ROOT) -> list[Path]:
    """Return every file of the course that a grading of the assignment reads, in order; arguments as for `digest`."""
    chapter = root / "chapters" / assignment
    shared = [root / name for name in ("autograder", "sim", "assets/worlds", *reads)]
    own = [*_packages(assignment, root), chapter / f"{assignment}.ipynb", chapter / "ws" / "src"]
    return sorted({path for top in shared + own for path in _below(top, root / "autograder")})


def _packages(assignment: str, root: Path) -> set[Path]:
    """Return the folder of the assignment's checks and those of all chapters that these import from."""
    home = root / "autograder" / "checks"
    pending = [home / f"ch{assignment}"]
    found: set[Path] = set()
    while pending:
        folder = pending.pop()
        if folder not in found:
            found.add(folder)
            texts = (path.read_text(encoding="utf-8") for path in folder.rglob("*.py") if not _proves(path, home))
            pending += [home / name for text in texts for name in MENTION.findall(text)]
    return found


def _proves(path: Path, home: Path) -> bool:
    """Return whether a path below the checks is, or lies in, what proves them."""
    return not PROOF.isdisjoint(path.relative_to(home).parts)


def _below(path: Path, grader: Path) -> Iterator[Path]:
    """Yield a file, or the files of a folder without what no grading reads and without the chapters' checks."""
    if path.is_file():
        yield path
    for child in path.iterdir() if path.is_dir() else ():
        apart = path == grader and child.name in APART
        home = grader / "checks"
        proof = child.is_relative_to(home) and _proves(child, home)
        checks = path == home and CHAPTER.match(child.name)
        if not (apart or proof or checks or child.name.startswith(".") or child.name == "__pycache__"):
            yield from _below(child, grader)
