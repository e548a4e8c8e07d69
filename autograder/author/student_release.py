"""Describes a student release, and updates it to a later one.

`release.json` in a student release contains the version, the digest of each file, and the digest of each cell of the
notebooks. If the digest of a file or cell differs, the student has changed it. An update does not touch such changes in
`chapters/`. Elsewhere, the course's file replaces the student's, which is kept beside it.
"""

from __future__ import annotations

import hashlib
import itertools
import json
import shutil
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import nbformat
from nbformat import NotebookNode

from autograder.exceptions import UsageError
from autograder.result.model import write_atomically, write_json

MANIFEST = "release.json"
STUDENT_FOLDER = "chapters"  # where students write; all other files belong to the course


@dataclass(frozen=True)
class Manifest:
    """The description of a student release.

    Attributes:
        version: the time of its creation in UTC, so that versions sort chronologically.
        course: the folder in which the class finds its newest release, or an empty string.
        files: the digest of each file, by its path in the release.
        cells: for each notebook, the digest of each cell's text, by the cell's id.
    """

    version: str
    course: str
    files: dict[str, str]
    cells: dict[str, dict[str, str]]


def write_manifest(release: Path, version: str, course: str) -> None:
    """Write the manifest of an otherwise complete student release."""
    files = {str(path.relative_to(release)): _digest(path.read_bytes()) for path in _files(release)}
    cells = {
        name: {cell.id: _digest(cell.source.encode()) for cell in nbformat.read(release / name, as_version=4).cells}
        for name in files
        if name.endswith(".ipynb")
    }
    write_json(release / MANIFEST, asdict(Manifest(version, course, files, cells)))


def read_manifest(release: Path) -> Manifest:
    """Read the manifest of a student release.

    Raises:
        UsageError: it does not exist or cannot be read.
    """
    try:
        return Manifest(**json.loads((release / MANIFEST).read_text(encoding="utf-8")))
    except (OSError, ValueError, TypeError) as error:
        raise UsageError(f"{release} is not a release of the course: {error}") from None


@dataclass(frozen=True)
class Update:
    """The outcome of an update. All paths are relative to the student release.

    Attributes:
        written: the files that were written.
        skipped: the files in `chapters/` that were not written, because the student has changed them.
        backups: for each overwritten file elsewhere that the student had changed, the path of the student's copy.
    """

    written: Sequence[str]
    skipped: Sequence[str]
    backups: Mapping[str, str]


def update_release(release: Path, newer: Path) -> Update:
    """Update a student release to a later one, which may contain only some chapters.

    Raises:
        UsageError: one of the folders is not a student release, or `newer` is older.
    """
    old, new = read_manifest(release), read_manifest(newer)
    if new.version < old.version:
        raise UsageError(f"{newer} has version {new.version}, but the release here is newer, {old.version}")
    written: list[str] = []
    skipped: list[str] = []
    backups: dict[str, str] = {}
    for name, digest in new.files.items():
        source, target = newer / name, release / name
        current = _digest(target.read_bytes()) if target.is_file() else None
        is_changed = current not in (None, old.files.get(name))
        if current == digest:
            continue
        if is_changed and name.startswith(f"{STUDENT_FOLDER}/"):
            if name.endswith(".ipynb"):
                merged_notebook = _merge_notebooks(
                    nbformat.read(target, 4), nbformat.read(source, 4), old.cells.get(name, {})
                )
                write_atomically(target, nbformat.writes(merged_notebook).encode())
                written.append(name)
            else:
                skipped.append(name)
            continue
        if is_changed:
            backups[name] = str(_back_up(target).relative_to(release))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(source, target)
        written.append(name)
    chapters = {name.split("/")[1] for name in new.files if name.startswith(f"{STUDENT_FOLDER}/")}
    absent_chapter_files = {
        name for name in old.files if name.startswith(f"{STUDENT_FOLDER}/") and name.split("/")[1] not in chapters
    }
    for name in old.files.keys() - new.files.keys() - absent_chapter_files:
        if (release / name).is_file() and _digest((release / name).read_bytes()) == old.files[name]:
            (release / name).unlink()
    files = {name: old.files[name] for name in absent_chapter_files} | new.files
    cells = {name: old.cells[name] for name in absent_chapter_files & old.cells.keys()} | new.cells
    write_json(release / MANIFEST, asdict(Manifest(new.version, new.course or old.course, files, cells)))
    return Update(written, skipped, backups)


def _back_up(file: Path) -> Path:
    """Copy a file to an unused name beside it, and return the copy's path."""
    names = (f"{file.name}.yours{number or ''}" for number in itertools.count())
    copy = next(path for path in map(file.with_name, names) if not path.exists())
    shutil.copy2(file, copy)
    return copy


def _merge_notebooks(
    student_notebook: NotebookNode, released: NotebookNode, old_digests: dict[str, str]
) -> NotebookNode:
    """Update the cells of a student's notebook that the student has not changed, and return the notebook."""
    new = {cell.id: cell for cell in released.cells}
    cells = []
    for cell in student_notebook.cells:
        is_unchanged = old_digests.get(cell.id) == _digest(cell.source.encode())
        if is_unchanged and cell.id in new and cell.source != new[cell.id].source:
            cells.append(new[cell.id])
        elif not is_unchanged or cell.id in new:
            cells.append(cell)
    previous_id = None
    for cell in released.cells:  # a new cell follows the same cell as in the release
        if cell.id not in old_digests:
            index = next((number for number, other in enumerate(cells, start=1) if other.id == previous_id), len(cells))
            cells.insert(index if previous_id else 0, cell)
        previous_id = cell.id
    student_notebook.cells = cells
    return student_notebook


def _files(release: Path) -> Iterator[Path]:
    return (path for path in sorted(release.rglob("*")) if path.is_file() and path.name != MANIFEST)


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
