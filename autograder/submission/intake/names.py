"""Recognises notebooks, archives and assignments by the names of files."""

from __future__ import annotations

from pathlib import PurePosixPath

NOTEBOOKS = (".ipynb", ".ipynb.txt", ".ipynb.json")  # browsers add a suffix to files that they show as text
# They include archives that the grader cannot open, so that it can report them.
ARCHIVES = (
    *(".zip", ".tar", ".tar.gz", ".tgz", ".tar.bz2", ".tbz2", ".tbz", ".tar.xz", ".txz"),
    *(".gz", ".bz2", ".xz", ".7z", ".rar", ".zst", ".tzst", ".tar.zst"),
)


def is_notebook(name: str) -> bool:
    """Return whether a file's name is that of a notebook."""
    return name.casefold().endswith(NOTEBOOKS)


def is_archive(name: str) -> bool:
    """Return whether a file's name is that of an archive."""
    return name.casefold().endswith(ARCHIVES)


def names_assignment(name: str, assignment: str) -> bool:
    """Return whether a file is named after an assignment: `10_mapping (1).ipynb`, `Copy of 10_mapping.ipynb`."""
    return _letters_and_digits(assignment) in _letters_and_digits(PurePosixPath(name).name)


def stem(name: str) -> str:
    """Return a file's name without the endings of archives and notebooks: `ada` for `ada.tar.gz` and `ada.ZIP`."""
    low = name.casefold()
    endings = (ending for ending in (*ARCHIVES, *NOTEBOOKS) if low.endswith(ending) and len(low) > len(ending))
    return name[: len(name) - len(max(endings, key=len, default=""))]


def reading_rank(path: PurePosixPath) -> int:
    """Return the reading order of a file: possible answers come before other files."""
    if "src" in path.parts or is_notebook(path.name):
        return 0
    return 1 if is_archive(path.name) else 2


def _letters_and_digits(name: str) -> str:
    return "".join(filter(str.isalnum, name.casefold()))
