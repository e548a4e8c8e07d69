"""What travels between client and worker: bounded bytes, packed by msgpack, which holds no code.

A `Parcel` goes to a worker, an `Answer` comes back. Neither names the student.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any

import msgpack

from autograder.grade.answer import AnswerError
from autograder.grade.cluster.exceptions import ClusterError
from autograder.grade.job import Job
from autograder.run.sandbox import Tier
from autograder.submission.intake import MAX_FILES, MAX_TOTAL_BYTES, SubmittedFile

MAX_PARCEL = MAX_TOTAL_BYTES + MAX_FILES * 512  # bytes: the files of a submission, and their names
MAX_ANSWER = 64 * 1024 * 1024  # bytes
MAX_ANSWER_FILES = 200


@dataclass(frozen=True)
class Parcel:
    """A submission on its way to a worker: all its files, as intake read them, and what a grading has to know."""

    job: Job  # without the student, and without paths
    files: tuple[SubmittedFile, ...]

    def pack(self) -> bytes:
        """Return the parcel as bytes. Equal parcels give equal bytes."""
        files = sorted((os.fsencode(file.path), file.data, file.executable) for file in self.files)
        packed: bytes = msgpack.packb([self.job.assignment, self.job.seed, self.job.tier.value, files])
        return packed

    @classmethod
    def unpack(cls, data: bytes) -> Parcel:
        """Read a parcel. Raises ClusterError if the bytes hold none."""
        try:
            assignment, seed, tier, files = _unpacked(data, MAX_PARCEL)
            entries = [SubmittedFile(PurePosixPath(os.fsdecode(n)), bytes(d), bool(x)) for n, d, x in files]
            job = Job(Path(), str(assignment), "", int(seed), Path(), Tier(tier))
        except (ValueError, TypeError) as error:
            raise ClusterError(f"the parcel of a submission cannot be read: {error}") from None
        if any(file.path.is_absolute() or ".." in file.path.parts for file in entries):
            raise ClusterError("the parcel of a submission names a file outside of it")
        return cls(job, tuple(entries))


@dataclass(frozen=True)
class Answer:
    """What a grading left, on its way back: files by their names, or the reason why the worker could not grade."""

    files: Mapping[str, bytes]
    failure: str = ""

    def pack(self) -> bytes:
        """Return the answer as bytes; one that is too large is a failure."""
        packed: bytes = msgpack.packb([dict(self.files), self.failure], unicode_errors="surrogateescape")
        if len(packed) <= MAX_ANSWER and len(self.files) <= MAX_ANSWER_FILES:
            return packed
        return Answer({}, f"the grading left {len(self.files)} files in {len(packed)} bytes, which is too much").pack()

    @classmethod
    def unpack(cls, data: object) -> Answer:
        """Read what a worker sent. Raises AnswerError if it breaks a bound, or is no answer."""
        if not isinstance(data, bytes):
            raise AnswerError(f"a worker sent {type(data).__name__} instead of bytes")
        try:
            return cls(*_answer(data))
        except (ValueError, TypeError, msgpack.UnpackException) as error:
            raise AnswerError(f"a worker's answer cannot be read: {error}") from None


def _answer(data: bytes) -> tuple[dict[str, bytes], str]:
    """Read an answer piece by piece: in one piece, 64 MiB could be as many empty lists."""
    if len(data) > MAX_ANSWER:
        raise ValueError(f"it has {len(data)} bytes, and {MAX_ANSWER} is the most")
    pieces = msgpack.Unpacker(
        max_array_len=0, max_map_len=0, max_buffer_size=MAX_ANSWER, unicode_errors="surrogateescape"
    )
    pieces.feed(data)
    if pieces.read_array_header() != 2 or (count := pieces.read_map_header()) > MAX_ANSWER_FILES:
        raise ValueError("it is not made of named files")
    *files, failure = [pieces.unpack() for _ in range(2 * count + 1)]
    names, contents = files[::2], files[1::2]
    if not all(isinstance(text, str) for text in (*names, failure)) or not all(isinstance(c, bytes) for c in contents):
        raise ValueError("it is not made of named files")
    return dict(zip(names, contents, strict=True)), failure


def _unpacked(data: bytes, most: int) -> Any:
    if len(data) > most:
        raise ValueError(f"it has {len(data)} bytes, and {most} is the most")
    try:
        return msgpack.unpackb(data, unicode_errors="surrogateescape", strict_map_key=True)
    except RecursionError:
        raise ValueError("it is nested too deep") from None
    except msgpack.UnpackException as error:
        raise ValueError(str(error)) from None
