"""Reads a submission into memory, and refuses an unsafe one.

A submission is the folder of an assignment (the notebook and `ws/` beside it), a zip archive of such a folder, the
notebook alone, or a source tree with `src/`. Nothing in it is executed here. Links, devices, absolute paths and parent
paths are refused. Sizes, counts and depths are limited. The folders `build`, `install` and `log` are ignored.
"""

from __future__ import annotations

import hashlib
import lzma
import os
import stat
import zipfile
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError, UsageError

MAX_FILES = 2000
MAX_FILE_BYTES = 16 * 1024 * 1024
MAX_TOTAL_BYTES = 64 * 1024 * 1024
MAX_DEPTH = 16  # parts of a path
MAX_PATH_BYTES = 200  # file systems allow 255 for each part
IGNORED = frozenset(
    {"build", "install", "log", "__pycache__", ".ipynb_checkpoints", ".git", ".pytest_cache", "__MACOSX"}
)
_EXECUTABLE = 0o100
# `zipfile` raises these for an archive that is damaged, encrypted or compressed by an unknown method.
_DAMAGED = (
    zipfile.BadZipFile,
    zipfile.LargeZipFile,
    zlib.error,
    lzma.LZMAError,
    NotImplementedError,
    EOFError,
    OSError,
    RuntimeError,
    ValueError,
)


@dataclass(frozen=True)
class SubmittedFile:
    """A file of a submission, by its path below the root or a folder of it."""

    path: PurePosixPath
    data: bytes
    executable: bool = False


@dataclass(frozen=True)
class Submission:
    """The files of a submission, in the layout that grading uses."""

    notebook: bytes | None  # content of the assignment's notebook, or None
    source: tuple[SubmittedFile, ...]  # files below `ws/src`, with paths relative to it
    # Files beside the notebook that it may read, with paths relative to the assignment's folder.
    extra: tuple[SubmittedFile, ...]
    sha256: str  # digest of all files' paths and contents, in hexadecimal digits
    graded_sha256: str  # likewise, of what a grading reads: a folder and a zip of it have the same


def read_packages(root: Path) -> tuple[SubmittedFile, ...]:
    """Read the files in `root`/src, a workspace that a student's code may have changed, with paths relative to it.

    Raises:
        StudentError: `src` is not a folder, or holds something unsafe.
    """
    for folder in (root, root / "src"):
        try:
            mode = folder.lstat().st_mode
        except OSError:
            mode = 0
        if not stat.S_ISDIR(mode):
            sentence = "After the notebook has run there is no folder ws/src: create your package there."
            raise StudentError(Diagnosis(Kind.NOTHING_SUBMITTED, sentence))
    return tuple(_from_folder(root / "src", _Budget()))


def read_submission(path: Path, assignment: str) -> Submission:
    """Read a submission of an assignment from disk: a folder, a zip archive or a notebook.

    Raises:
        UsageError: `path` does not exist.
        StudentError: the submission is unsafe or unreadable, or has neither the notebook nor a package.
    """
    return detect_layout(read_files(path, assignment), assignment)


def read_files(path: Path, assignment: str) -> list[SubmittedFile]:
    """Read all files of a submission, with paths below its root. Args and errors are those of `read_submission`."""
    budget = _Budget()
    if path.is_dir():
        return _from_folder(path, budget)
    if path.is_file() and path.suffix == ".ipynb":
        return [budget.read(PurePosixPath(f"{assignment}.ipynb"), path.stat().st_size, path.read_bytes)]
    if path.is_file():
        return _from_zip(path, budget)
    raise UsageError(f"{path}: there is no such file or folder")


def detect_layout(entries: list[SubmittedFile], assignment: str) -> Submission:
    """Find the notebook and the packages among a submission's files, whose paths are below its root.

    Raises:
        StudentError: there is neither the notebook nor a package, or a file and a folder have the same path.
    """
    _require_tree(entries)
    root = _root(entries, assignment)
    inside = [
        SubmittedFile(entry.path.relative_to(root), entry.data, entry.executable)
        for entry in entries
        if _below(entry, root)
    ]
    notebook = next((entry.data for entry in inside if str(entry.path) == f"{assignment}.ipynb"), None)
    workspace = PurePosixPath("ws/src")
    home = workspace if any(_below(entry, workspace) for entry in inside) else PurePosixPath("src")
    source, extra = [], []
    for entry in inside:
        if _below(entry, home):
            source.append(SubmittedFile(entry.path.relative_to(home), entry.data, entry.executable))
        elif entry.path.parts[0] != "ws" and str(entry.path) != f"{assignment}.ipynb":
            extra.append(entry)
    if notebook is None and not source:
        sentence = (
            f"There is nothing to grade: neither {assignment}.ipynb nor a ws/src folder with a package. Hand in the "
            "assignment's whole folder."
        )
        raise StudentError(Diagnosis(Kind.NOTHING_SUBMITTED, sentence))
    return Submission(notebook, tuple(source), tuple(extra), _digest(entries), _digest(inside))


def _digest(entries: list[SubmittedFile]) -> str:
    digest = hashlib.sha256()
    for entry in sorted(entries, key=lambda entry: str(entry.path)):
        digest.update(f"{entry.path}\0{len(entry.data)}\0{entry.executable:d}".encode(errors="surrogatepass"))
        digest.update(entry.data)
    return digest.hexdigest()


def write_tree(entries: tuple[SubmittedFile, ...], folder: Path) -> None:
    """Write files below `folder`, and create the folder if it does not exist."""
    folder.mkdir(parents=True, exist_ok=True)
    for entry in entries:
        target = folder / entry.path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(entry.data)
        if entry.executable:
            target.chmod(0o755)


def _root(entries: list[SubmittedFile], assignment: str) -> PurePosixPath:
    """Return the shallowest folder that holds the notebook, `ws/src` or `src`."""
    candidates = []
    for entry in entries:
        parts = entry.path.parts
        if entry.path.name == f"{assignment}.ipynb" and len(parts) <= 3:
            candidates.append((len(parts) - 1, 0, PurePosixPath(*parts[:-1])))
        for marker in (("ws", "src"), ("src",)):
            for depth in range(min(3, len(parts) - len(marker))):
                if parts[depth : depth + len(marker)] == marker:
                    candidates.append((depth, len(marker), PurePosixPath(*parts[:depth])))
    return min(candidates)[2] if candidates else PurePosixPath()


def _below(entry: SubmittedFile, root: PurePosixPath) -> bool:
    return entry.path.is_relative_to(root) and entry.path != root


def _require_tree(entries: list[SubmittedFile]) -> None:
    """Refuse two files with the same path, and a file whose path is also that of a folder."""
    files = {entry.path for entry in entries}
    folders = {folder for path in files for folder in path.parents}
    if len(files) < len(entries) or files & folders:
        raise _unsafe("two of its files or folders have the same path")


class _Budget:
    """Counts bytes before they are read, so that no more than `MAX_TOTAL_BYTES` are ever in memory."""

    def __init__(self) -> None:
        self._left = MAX_TOTAL_BYTES

    def read(
        self, path: PurePosixPath, size: int, read: Callable[[], bytes], executable: bool = False
    ) -> SubmittedFile:
        if len(path.parts) > MAX_DEPTH:
            raise _unsafe(f"folders are nested more than {MAX_DEPTH} deep")
        if len(os.fsencode(path)) > MAX_PATH_BYTES:
            raise _unsafe(f"the name {str(path)[:60]!r}... is longer than {MAX_PATH_BYTES} bytes")
        if size > MAX_FILE_BYTES:
            raise _unsafe(f"{path} is larger than {MAX_FILE_BYTES // 2**20} MiB")
        self._left -= size
        if self._left < 0:
            raise _unsafe(f"it is larger than {MAX_TOTAL_BYTES // 2**20} MiB in all")
        return SubmittedFile(path, read(), executable)


def _from_folder(root: Path, budget: _Budget) -> list[SubmittedFile]:
    return [
        budget.read(
            PurePosixPath(path.relative_to(root)), info.st_size, path.read_bytes, bool(info.st_mode & _EXECUTABLE)
        )
        for path, info in _walk(root)
    ]


def _walk(root: Path) -> Iterator[tuple[Path, os.stat_result]]:
    pending, count = [root], 0
    while pending:
        for path in sorted(pending.pop().iterdir()):
            if path.name in IGNORED:
                continue
            info = path.lstat()
            count += 1
            if count > MAX_FILES:
                raise _unsafe(f"it holds more than {MAX_FILES} files and folders")
            if stat.S_ISDIR(info.st_mode):
                if len(path.relative_to(root).parts) > MAX_DEPTH:
                    raise _unsafe(f"folders are nested more than {MAX_DEPTH} deep")
                pending.append(path)
            elif stat.S_ISREG(info.st_mode):
                yield path, info
            else:
                what = "a symbolic link" if stat.S_ISLNK(info.st_mode) else "not a regular file"
                raise _unsafe(f"{path.relative_to(root)} is {what}")


def _from_zip(path: Path, budget: _Budget) -> list[SubmittedFile]:
    if path.stat().st_size > MAX_TOTAL_BYTES:
        raise _unsafe(f"it is larger than {MAX_TOTAL_BYTES // 2**20} MiB")
    try:
        with zipfile.ZipFile(path) as archive:
            infos = archive.infolist()
            if len(infos) > MAX_FILES:
                raise _unsafe(f"it holds more than {MAX_FILES} files and folders")
            return [entry for info in infos if (entry := _zip_entry(archive, info, budget)) is not None]
    except _DAMAGED as error:
        sentence = f"{path.name} is not a folder, a notebook or a readable zip archive ({error}): hand in one of these."
        raise StudentError(Diagnosis(Kind.UNREADABLE, sentence)) from None


def _zip_entry(archive: zipfile.ZipFile, info: zipfile.ZipInfo, budget: _Budget) -> SubmittedFile | None:
    path = PurePosixPath(info.filename.replace("\\", "/"))
    if path.is_absolute() or ".." in path.parts or (path.parts and path.parts[0].endswith(":")):
        raise _unsafe(f"{info.filename} points outside the archive")
    if info.is_dir() or IGNORED.intersection(path.parts):
        return None
    mode = info.external_attr >> 16
    if stat.S_IFMT(mode) not in (0, stat.S_IFREG):
        raise _unsafe(f"{info.filename} is not a regular file")
    return budget.read(path, info.file_size, lambda: _inflate(archive, info), bool(mode & _EXECUTABLE))


def _inflate(archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> bytes:
    # The archive's directory may state a wrong size: read at most one byte more than it states.
    with archive.open(info) as stream:
        data = stream.read(info.file_size + 1)
    if len(data) != info.file_size:
        raise zipfile.BadZipFile(f"{info.filename} is not as large as the archive says")
    return data


def _unsafe(why: str) -> StudentError:
    return StudentError(
        Diagnosis(
            Kind.UNSAFE_ARCHIVE,
            f"The submission was not opened: {why}. Hand in the notebook and ws/src, without links and without what "
            "colcon builds.",
        )
    )
