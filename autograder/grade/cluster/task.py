"""The messages between client and worker. Their size is limited, and their format, msgpack, cannot contain code.

The client sends a `Task` to a worker and gets a `Reply`. Neither contains the student's name.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any

import msgpack

from autograder.grade.cluster.exceptions import ClusterError
from autograder.grade.job import Job
from autograder.grade.reply import ReplyError
from autograder.run.sandbox import Isolation
from autograder.submission.intake import MAX_FILES, MAX_TOTAL_BYTES, SubmittedFile

MAX_TASK = MAX_TOTAL_BYTES + MAX_FILES * 512  # bytes: the files of a submission, and their names
MAX_REPLY = 64 * 1024 * 1024  # bytes
MAX_REPLY_FILES = 200


@dataclass(frozen=True)
class Task:
    """A submission to grade: its job, and all its files as intake read them."""

    job: Job  # without the student's name and without paths
    files: tuple[SubmittedFile, ...]

    def pack(self) -> bytes:
        """Return the task as bytes. Equal tasks give equal bytes."""
        files = sorted((os.fsencode(file.path), file.data, file.executable) for file in self.files)
        packed: bytes = msgpack.packb([self.job.assignment, self.job.seed, self.job.isolation.value, files])
        return packed

    @classmethod
    def unpack(cls, data: bytes) -> Task:
        """Read a task. Raises ClusterError if the bytes are not a valid task."""
        try:
            assignment, seed, isolation, files = _unpack(data)
            entries = [
                SubmittedFile(PurePosixPath(os.fsdecode(name)), bytes(content), bool(executable))
                for name, content, executable in files
            ]
            job = Job(Path(), str(assignment), "", int(seed), Path(), Isolation(isolation))
        except (ValueError, TypeError) as error:
            raise ClusterError(f"a task cannot be read: {error}") from None
        if any(file.path.is_absolute() or ".." in file.path.parts for file in entries):
            raise ClusterError("a task names a file outside of the submission")
        return cls(job, tuple(entries))


@dataclass(frozen=True)
class Reply:
    """The files that a grading wrote, by name, or the reason why the worker could not grade."""

    files: Mapping[str, bytes]
    failure: str = ""

    def pack(self) -> bytes:
        """Return the reply as bytes. A reply that is too large becomes a failure."""
        packed: bytes = msgpack.packb([dict(self.files), self.failure], unicode_errors="surrogateescape")
        if len(packed) <= MAX_REPLY and len(self.files) <= MAX_REPLY_FILES:
            return packed
        return Reply({}, f"the grading wrote too much: {len(self.files)} files in {len(packed)} bytes").pack()

    @classmethod
    def unpack(cls, data: object) -> Reply:
        """Read a worker's reply. Raises ReplyError if it exceeds a limit or is not a valid reply."""
        if not isinstance(data, bytes):
            raise ReplyError(f"a worker sent {type(data).__name__} instead of bytes")
        try:
            return cls(*_read_reply(data))
        except (ValueError, TypeError, msgpack.UnpackException) as error:
            raise ReplyError(f"a worker's reply cannot be read: {error}") from None


def _read_reply(data: bytes) -> tuple[dict[str, bytes], str]:
    """Read a reply piece by piece, because unpacking 64 MiB at once could create 64 million empty lists."""
    if len(data) > MAX_REPLY:
        raise ValueError(f"it has {len(data)} bytes, but at most {MAX_REPLY} are allowed")
    unpacker = msgpack.Unpacker(
        max_array_len=0, max_map_len=0, max_buffer_size=MAX_REPLY, unicode_errors="surrogateescape"
    )
    unpacker.feed(data)
    if unpacker.read_array_header() != 2 or (count := unpacker.read_map_header()) > MAX_REPLY_FILES:
        raise ValueError("it does not consist of named files")
    *files, failure = [unpacker.unpack() for _ in range(2 * count + 1)]
    names, contents = files[::2], files[1::2]
    if not all(isinstance(text, str) for text in (*names, failure)) or not all(isinstance(c, bytes) for c in contents):
        raise ValueError("it does not consist of named files")
    return dict(zip(names, contents, strict=True)), failure


def _unpack(data: bytes) -> Any:
    if len(data) > MAX_TASK:
        raise ValueError(f"it has {len(data)} bytes, but at most {MAX_TASK} are allowed")
    try:
        return msgpack.unpackb(data, unicode_errors="surrogateescape", strict_map_key=True)
    except RecursionError:
        raise ValueError("it is nested too deeply") from None
    except msgpack.UnpackException as error:
        raise ValueError(str(error)) from None
