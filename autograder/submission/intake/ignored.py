"""The files and folders that tools leave beside an answer, and that no student submits on purpose."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import PurePosixPath

from autograder.submission.intake.files import MAX_DEPTH, unsafe

# The output of colcon, the files of Python, Jupyter and version control, and those that operating systems add.
IGNORED = frozenset(
    {"build", "install", "log", "__pycache__", ".ipynb_checkpoints", ".pytest_cache", ".mypy_cache", ".ruff_cache"}
    | {".hypothesis", ".tox", ".nox", ".cache", ".git", ".svn", ".hg", ".venv", "venv", "node_modules", ".Trash"}
    | {"__MACOSX", ".DS_Store", "Thumbs.db", "desktop.ini", ".Spotlight-V100", ".fseventsd", "@eaDir"}
)
_APPLE_DOUBLE = "._"  # the prefix of files in which macOS stores attributes of other files
# A folder that contains one of these is an environment of Python or conda, whatever its name.
_ENVIRONMENT_MARKS = frozenset({"pyvenv.cfg", "conda-meta"})
# If a folder with such a mark also contains an answer, only these entries belong to the environment.
_ENVIRONMENT_PARTS = frozenset(
    {"bin", "lib", "lib64", "include", "share", "etc", "pyvenv.cfg", "conda-meta", "Scripts", "Lib", "Include"}
)
_ANSWER_PARTS = ("ws", "src")
_MAX_PARTS = MAX_DEPTH + 1  # parts of a path that are examined; nothing deeper is read
MAX_ENVIRONMENTS = 1000


def is_ignored(name: str) -> bool:
    """Return whether a file or folder with this name is never part of a submission."""
    return name in IGNORED or name.startswith(_APPLE_DOUBLE)


def environment_parts(names: Iterable[str]) -> frozenset[str]:
    """Return the entries of a folder that belong to an environment: all, unless the folder also contains an answer."""
    entries = frozenset(names)
    if not entries & _ENVIRONMENT_MARKS:
        return frozenset()
    return entries & _ENVIRONMENT_PARTS if any(map(_is_answer, entries)) else entries


def _is_answer(name: str) -> bool:
    return name in _ANSWER_PARTS or name.casefold().endswith(".ipynb")


@dataclass
class _Folder:
    """A folder that has the mark of an environment, or contains such a folder."""

    folders: dict[str, _Folder] = field(default_factory=dict)
    is_marked: bool = False
    has_answer: bool = False


class IgnoredPaths:
    """Decides for each path of an archive whether it is part of the submission.

    Each path is examined once, and only to the depth that answers can have. Raises StudentError if the archive
    contains more environments than is plausible.
    """

    def __init__(self, paths: Iterable[PurePosixPath]) -> None:
        paths = list(paths)
        self._root, count = _Folder(), 0
        for path in paths:
            parts = path.parts[:_MAX_PARTS]
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
            for folder, name in self._known_folders(path):
                folder.has_answer = folder.has_answer or _is_answer(name)

    def __contains__(self, path: PurePosixPath) -> bool:
        if any(map(is_ignored, path.parts)):
            return True
        return any(
            folder.is_marked and (not folder.has_answer or name in _ENVIRONMENT_PARTS)
            for folder, name in self._known_folders(path)
        )

    def _known_folders(self, path: PurePosixPath) -> Iterator[tuple[_Folder, str]]:
        """Yield the known folders on a path, each with the path's next name in it."""
        folder: _Folder | None = self._root
        for name in path.parts:
            if folder is None:
                return
            yield folder, name
            folder = folder.folders.get(name)
