"""The files of a submission in memory, and how much of it is read."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.submission.intake.names import is_archive, is_notebook
from autograder.submission.intake.notebooks import without_outputs

MAX_FILES = 2000
MAX_FILE_BYTES = 16 * 1024 * 1024
MAX_WRAPPED_BYTES = 64 * 1024 * 1024  # of a notebook whose outputs are dropped, and of an archive in an archive
MAX_TOTAL_BYTES = 64 * 1024 * 1024
MAX_READ_BYTES = 256 * 1024 * 1024  # that are decompressed to find the files
# That decompressing makes, in all archives: one is read up to three times, its names, then its answers, then the rest.
MAX_UNPACKED_BYTES = 4 * MAX_READ_BYTES
MAX_SCANNED = 100_000  # files and folders that are looked at
MAX_DEPTH = 16  # parts of a path
MAX_PATH_BYTES = 200  # file systems allow 255 for each part


@dataclass(frozen=True)
class SubmittedFile:
    """A file of a submission, by its path below the root or a folder of it."""

    path: PurePosixPath
    data: bytes
    executable: bool = False


@dataclass(frozen=True)
class LeftOut:
    """A file of a submission that was not read: its path, and the reason, which follows the path in a sentence."""

    path: PurePosixPath
    why: str
    whole: str = ""  # the reason as a whole sentence, if the path is of no help
    may_hold_answer: bool = False  # whether it is an archive or a notebook

    @property
    def sentence(self) -> str:
        """The path with the reason."""
        return self.whole or f"{self.path} {self.why}"


@dataclass
class Contents:
    """The files of a submission, and those that were left out. It counts bytes before they are read."""

    files: list[SubmittedFile] = field(default_factory=list)
    left_out: list[LeftOut] = field(default_factory=list)
    kept: int = 0  # bytes in memory
    read: int = 0  # bytes that were read or decompressed
    unpacked: int = 0  # decompressed bytes, including those of skipped files
    scanned: int = 0
    archives: int = 0

    def scan(self) -> None:
        """Count a file or folder that was looked at."""
        self.scanned += 1
        if self.scanned > MAX_SCANNED:
            raise unsafe(f"it holds more than {MAX_SCANNED:,} files and folders")

    def take(self, file: SubmittedFile) -> None:
        """Remove a file whose own files take its place."""
        self.files.remove(file)
        self.kept -= len(file.data)

    def drop(self, first: int) -> None:
        """Remove the files from a place on."""
        self.kept -= sum(len(file.data) for file in self.files[first:])
        del self.files[first:]

    def omit(self, path: PurePosixPath, why: str, whole: str = "") -> None:
        """Record a file that is not read."""
        may_hold_answer = is_archive(path.name) or is_notebook(path.name)
        self.left_out.append(LeftOut(path, why, whole, may_hold_answer))

    def add(self, path: PurePosixPath, size: int, read: Callable[[], bytes], executable: bool = False) -> None:
        """Read a file, unless it breaks a bound; then note the reason."""
        wrapped = is_notebook(path.name) or is_archive(path.name)
        largest = MAX_WRAPPED_BYTES if wrapped else MAX_FILE_BYTES
        if len(path.parts) > MAX_DEPTH:
            self.omit(path, "", f"folders are nested more than {MAX_DEPTH} deep")
        elif len(os.fsencode(path)) > MAX_PATH_BYTES:
            self.omit(path, "", f"the name {str(path)[:60]!r}... is longer than {MAX_PATH_BYTES} bytes")
        elif size > largest:
            self.omit(path, f"is larger than {largest // 2**20} MiB")
        elif len(self.files) >= MAX_FILES:
            self.omit(path, "", f"it holds more than {MAX_FILES} files")
        elif self.kept + min(size, MAX_FILE_BYTES) > MAX_TOTAL_BYTES or self.read + size > MAX_READ_BYTES:
            self.omit(path, "", f"it is larger than {MAX_TOTAL_BYTES // 2**20} MiB in all")
        else:
            self.read += size
            data = read()
            if len(data) > MAX_FILE_BYTES and is_notebook(path.name):
                data = without_outputs(data)
            if len(data) > MAX_FILE_BYTES and not is_archive(path.name):
                self.omit(path, f"is larger than {MAX_FILE_BYTES // 2**20} MiB without its outputs")
                return
            self.kept += len(data)
            self.files.append(SubmittedFile(path, data, executable))


def unsafe(why: str) -> StudentError:
    """Return the error of a submission that is not opened."""
    return StudentError(
        Diagnosis(
            Kind.UNSAFE_ARCHIVE,
            f"The submission was not opened: {why}. Hand in the notebook and ws/src, without links and without what "
            "colcon builds.",
        )
    )


def digest(files: Iterable[SubmittedFile]) -> str:
    """Return a digest of paths and contents, in hexadecimal digits."""
    sha256 = hashlib.sha256()
    for file in sorted(files, key=lambda file: str(file.path)):
        sha256.update(f"{file.path}\0{len(file.data)}\0{file.executable:d}".encode(errors="surrogatepass"))
        sha256.update(file.data)
    return sha256.hexdigest()


def write_tree(files: Iterable[SubmittedFile], folder: Path) -> None:
    """Write files below `folder`, and create the folder if it does not exist."""
    folder.mkdir(parents=True, exist_ok=True)
    for file in files:
        target = folder / file.path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(file.data)
        if file.executable:
            target.chmod(0o755)
