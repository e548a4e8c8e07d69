"""The files and folders beside an answer that tools leave there: nobody hands them in on purpose."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import PurePosixPath

# What colcon builds, what Python, Jupyter, editors and version control keep, and what systems add to folders.
IGNORED = frozenset(
    {"build", "install", "log", "__pycache__", ".ipynb_checkpoints", ".pytest_cache", ".mypy_cache", ".ruff_cache"}
    | {".hypothesis", ".tox", ".nox", ".cache", ".git", ".svn", ".hg", ".venv", "venv", "node_modules", ".Trash"}
    | {"__MACOSX", ".DS_Store", "Thumbs.db", "desktop.ini", ".Spotlight-V100", ".fseventsd", "@eaDir"}
)
_APPLE_DOUBLE = "._"
# A folder with one of these is an environment of Python or conda, whatever it is called.
_ENVIRONMENT_MARKS = frozenset({"pyvenv.cfg", "conda-meta"})
# What an environment puts into its folder, where somebody made it in the assignment's own.
_ENVIRONMENT_PARTS = frozenset(
    {"bin", "lib", "lib64", "include", "share", "etc", "pyvenv.cfg", "conda-meta", "Scripts", "Lib", "Include"}
)
_ANSWER_PARTS = ("ws", "src")


def is_ignored(name: str) -> bool:
    """Return whether a file or folder of this name is never part of a submission."""
    return name in IGNORED or name.startswith(_APPLE_DOUBLE)


def environment_parts(names: Iterable[str]) -> frozenset[str]:
    """Return which entries of a folder belong to an environment; all of them unless it holds an answer, too."""
    there = frozenset(names)
    if not there & _ENVIRONMENT_MARKS:
        return frozenset()
    holds_answer = any(name in _ANSWER_PARTS or name.casefold().endswith(".ipynb") for name in there)
    return there & _ENVIRONMENT_PARTS if holds_answer else there


class IgnoredPaths:
    """Says of each path of an archive whether it is part of the submission."""

    def __init__(self, paths: Iterable[PurePosixPath]) -> None:
        marks = [path for path in paths if _ENVIRONMENT_MARKS.intersection(path.parts)]
        self._folders = {
            PurePosixPath(*path.parts[:index])
            for path in marks
            for index, part in enumerate(path.parts)
            if part in _ENVIRONMENT_MARKS
        }
        entries: dict[PurePosixPath, set[str]] = {folder: set() for folder in self._folders}
        if self._folders:
            for path in paths:
                for folder in self._folders.intersection(path.parents):
                    entries[folder].add(path.relative_to(folder).parts[0])
        self._parts = {folder: environment_parts(names) for folder, names in entries.items()}

    def __contains__(self, path: PurePosixPath) -> bool:
        if any(map(is_ignored, path.parts)):
            return True
        above = self._folders.intersection(path.parents)
        return any(path.relative_to(folder).parts[0] in self._parts[folder] for folder in above)
