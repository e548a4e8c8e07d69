"""The files of a submission in memory, and the limits for reading them."""

from __future__ import annotations

import hashlib
import os
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.submission.intake.bounds import MAX_SECONDS
from autograder.submission.intake.names import is_archive, is_notebook
from autograder.submission.intake.notebooks import without_outputs

MAX_FILES = 2000
MAX_FILE_BYTES = 16 * 1024 * 1024
MAX_WRAPPED_BYTES = 64 * 1024 * 1024  # limit for a notebook whose outputs are dropped, and for an archive in an archive
MAX_TOTAL_BYTES = 64 * 1024 * 1024
MAX_READ_BYTES = 256 * 1024 * 1024  # read or decompressed, from one archive and for all files
# Limit for the decompressed bytes of all archives, and one for their compressed bytes. A tar is read up to three times:
# names, possible answers, the rest.
MAX_UNPACKED_BYTES = 4 * MAX_READ_BYTES
MAX_SCANNED = 100_000  # files, folders and parts of compressed files
MAX_DEPTH = 16  # parts of a path
MAX_PATH_BYTES = 200  # file systems allow 255 for each part


@dataclass(frozen=True)
class SubmittedFile:
    """A file of a submission. Its path is relative to the root of the submission, or to a folder in it."""

    path: PurePosixPath
    data: bytes
    executable: bool = False


@dataclass(frozen=True)
class SkippedFile:
    """A file of a submission that was not read."""

    path: PurePosixPath
    sentence: str  # the reason, for the student, without a full stop
    may_contain_answer: bool = False  # whether it is an archive or a notebook


@dataclass
class Contents:
    """The files of a submission, and those that were skipped. Bytes are counted before they are read."""

    files: list[SubmittedFile] = field(default_factory=list)
    skipped: list[SkippedFile] = field(default_factory=list)
    bytes_in_memory: int = 0
    bytes_read: int = 0  # including decompressed bytes
    bytes_packed: int = 0  # before they are decompressed
    bytes_unpacked: int = 0  # decompressed, including those of skipped files
    scanned: int = 0
    archives: int = 0
    started_at: float = field(default_factory=time.thread_time)  # processor time of this thread, in s

    def scan(self) -> None:
        """Count a file, a folder or a part of an archive. Raises StudentError if there are too many."""
        self.scanned += 1
        if self.scanned > MAX_SCANNED:
            raise unsafe(f"it holds more than {MAX_SCANNED:,} files and folders")
        self._limit_time()

    def count_packed(self, count: int) -> None:
        """Count bytes that are decompressed, even to nothing. Raises StudentError if there are too many."""
        self.bytes_packed += count
        self._limit_unpacking()

    def count_unpacked(self, count: int) -> None:
        """Count bytes that are read from an archive. Raises StudentError if there are too many."""
        self.bytes_unpacked += count
        self._limit_unpacking()

    def _limit_unpacking(self) -> None:
        if max(self.bytes_packed, self.bytes_unpacked) > MAX_UNPACKED_BYTES:
            raise unsafe("its archives contain too much data in all")
        self._limit_time()

    def _limit_time(self) -> None:
        """Raise a StudentError if reading has taken too long. `bounds` limits only processes with one thread."""
        if time.thread_time() - self.started_at > MAX_SECONDS:
            raise unsafe(f"reading it takes more than {MAX_SECONDS:.0f} s")

    def remove(self, file: SubmittedFile) -> None:
        """Remove an archive whose files replace it."""
        self.files.remove(file)
        self.bytes_in_memory -= len(file.data)

    def drop(self, first: int) -> None:
        """Remove the files from index `first` onwards."""
        self.bytes_in_memory -= sum(len(file.data) for file in self.files[first:])
        del self.files[first:]

    def skip(self, path: PurePosixPath, sentence: str) -> None:
        """Record that a file is not read. `sentence` tells the student why."""
        may_contain_answer = is_archive(path.name) or is_notebook(path.name)
        self.skipped.append(SkippedFile(path, sentence, may_contain_answer))

    def add(self, path: PurePosixPath, size: int, read: Callable[[], bytes], executable: bool = False) -> None:
        """Read a file, or skip it if it exceeds a limit."""
        is_wrapped = is_notebook(path.name) or is_archive(path.name)
        limit = MAX_WRAPPED_BYTES if is_wrapped else MAX_FILE_BYTES
        if len(path.parts) > MAX_DEPTH:
            self.skip(path, f"folders are nested more than {MAX_DEPTH} deep")
        elif len(os.fsencode(path)) > MAX_PATH_BYTES:
            self.skip(path, f"the name {str(path)[:60]!r}... is longer than {MAX_PATH_BYTES} bytes")
        elif size > limit:
            self.skip(path, f"{path} is larger than {limit // 2**20} MiB")
        elif len(self.files) >= MAX_FILES:
            self.skip(path, f"it holds more than {MAX_FILES} files")
        elif (
            self.bytes_in_memory + min(size, MAX_FILE_BYTES) > MAX_TOTAL_BYTES
            or self.bytes_read + size > MAX_READ_BYTES
        ):
            self.skip(path, f"it is larger than {MAX_TOTAL_BYTES // 2**20} MiB in all")
        else:
            self.bytes_read += size
            data = read()
            if len(data) > MAX_FILE_BYTES and is_notebook(path.name):
                data = without_outputs(data)
            if len(data) > MAX_FILE_BYTES and not is_archive(path.name):
                self.skip(path, f"{path} is larger than {MAX_FILE_BYTES // 2**20} MiB without its outputs")
                return
            self.bytes_in_memory += len(data)
            self.files.append(SubmittedFile(path, data, executable))


def unsafe(reason: str) -> StudentError:
    """Return the error for a submission that is not opened."""
    return StudentError(
        Diagnosis(
            Kind.UNSAFE_ARCHIVE,
            f"The submission was not opened: {reason}. Hand in the notebook and ws/src, without links and without the "
            "folders build, install and log.",
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
