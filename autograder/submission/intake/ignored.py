"""The files and folders that tools leave beside an answer, and that no student submits on purpose."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import PurePosixPath

from autograder.submission.intake.files import MAX_DEPTH, unsafe

# The output of colcon, files of Python, Jupyter, editors and version control, and files that systems add to folders.
IGNORED = frozenset(
    {"build", "install", "log", "__pycache__", ".ipynb_checkpoints", ".pytest_cache", ".mypy_cache", ".ruff_cache"}
    | {".hypothesis", ".tox", ".nox", ".cache", ".git", ".svn", ".hg", ".venv", "venv", "node_modules", ".Trash"}
    | {"__MACOSX", ".DS_Store", "Thumbs.db", "desktop.ini", ".Spotlight-V100", ".fseventsd", "@eaDir"}
)
_APPLE_DOUBLE = "._"
# A folder with one of these is an environment of Python or conda, whatever it is called.
_ENVIRONMENT_MARKS = frozenset({"pyvenv.cfg", "conda-meta"})
# The files of a virtual environment in its folder, if that is the assignment's own.
_ENVIRONMENT_PARTS = frozenset(
    {"bin", "lib", "lib64", "include", "share", "etc", "pyvenv.cfg", "conda-meta", "Scripts", "Lib", "Include"}
)
_ANSWER_PARTS = ("ws", "src")
_DEEPEST = MAX_DEPTH + 1  # parts of a path that are looked at: nothing below is read
MAX_ENVIRONMENTS = 1000


def is_ignored(name: str) -> bool:
    """Return whether a file or folder of this name is never part of a submission."""
    return name in IGNORED or name.startswith(_APPLE_DOUBLE)


def environment_parts(names: Iterable[str]) -> frozenset[str]:
    """Return which entries of a folder belong to an environment; all of them unless it holds an answer, too."""
    there = frozenset(names)
    if not there & _ENVIRONMENT_MARKS:
        return frozenset()
    return there & _ENVIRONMENT_PARTS if any(map(_is_answer, there)) else there


def _is_answer(name: str) -> bool:
    return name in _ANSWER_PARTS or name.casefold().endswith(".ipynb")


@dataclass
class _Folder:
    """A folder that is, or leads to, one with the mark of an environment."""

    folders: dict[str, _Folder] = field(default_factory=dict)
    is_marked: bool = False
    holds_answer: bool = False


class IgnoredPaths:
    """Decides for each path of an archive whether it is part of the submission.

    Each path is walked once, only as deep as answers can be. Raises StudentError if it has more environments than
    is plausible.
    """

    def __init__(self, paths: Iterable[PurePosixPath]) -> None:
        paths = list(paths)
        self._root, count = _Folder(), 0
        for path in paths:
            parts = path.parts[:_DEEPEST]
            marks = [index for index, part in enumerate(parts) if part in _ENVIRONMENT_MARKS]
            folder = self._root
            for index in range(marks[-1] + 1 if marks else 0):
                if parts[index] in _ENVIRONMENT_MARKS and not folder.is_marked:
                    folder.is_marked, count = True, count + 1
                if index < marks[-1]:
                    folder = folder.folders.setdefault(parts[index], _Folder())
            if count > MAX_ENVIRONMENTS:
                raise unsafe(f"it holds more than {MAX_ENVIRONMENTS} environments of Python")
        for path in paths:
            for folder, name in self._above(path):
                folder.holds_answer = folder.holds_answer or _is_answer(name)

    def __contains__(self, path: PurePosixPath) -> bool:
        if any(map(is_ignored, path.parts)):
            return True
        return any(
            folder.is_marked and (not folder.holds_answer or name in _ENVIRONMENT_PARTS)
            for folder, name in self._above(path)
        )

    def _above(self, path: PurePosixPath) -> Iterator[tuple[_Folder, str]]:
        """Find the folders that a path goes through, as far as they are known, each with the next name in it."""
        folder: _Folder | None = self._root
        for name in path.parts:
            if folder is None:
                return
            yield folder, name
            folder = folder.folders.get(name)
