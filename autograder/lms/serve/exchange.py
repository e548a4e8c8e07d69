"""Hands in the submissions that students make through nbgrader's exchange.

A submission is a folder STUDENT+ASSIGNMENT+TIME+RANDOM in the course's folder of the exchange. The student owns it and
can still change it. Therefore, a process that runs as the student packs it, without following links. The student can
also slow it down, stop it, and write to its pipe. So the time and the number of bytes that are read from the pipe are
limited, and a student whose submission cannot be packed has no further turn in the same poll.
"""

from __future__ import annotations

import asyncio
import hashlib
import logging
import os
import pwd
import selectors
import sqlite3
import stat
import subprocess
import time
import zlib
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from datetime import datetime, timezone
from pathlib import Path

from autograder.exceptions import UsageError
from autograder.lms.serve.shared import Refused, Service
from autograder.notebook.handing_in import MAX_ANSWER
from autograder.submission.intake.files import MAX_READ_BYTES

LOG = logging.getLogger(__name__)
LAST_FILE = "submission_secret.txt"  # nbgrader writes it after all others
POLL_SECONDS = 5.0  # real time between two polls of the exchange
MAX_PACK_SECONDS = 60.0  # real time in which `tar` has to pack a submission
_GZIP = 16 + zlib.MAX_WBITS  # see `zlib.compressobj`


@dataclass(frozen=True)
class ExchangeSubmission:
    """A submission in the exchange: its folder, its student with user and group ids, and the time of its completion."""

    folder: Path
    student: str
    user: int
    group: int
    assignment: str
    at: datetime

    @property
    def key(self) -> str:
        """The key under which it is handed in: the same in each poll, so that it is handed in only once."""
        return hashlib.sha256(self.folder.name.encode()).hexdigest()[:32]


def find_submissions(inbound: Path) -> Iterator[ExchangeSubmission]:
    """Yield the complete submissions of users of this machine. Folders that bear another user's name are ignored.

    Args:
        inbound: the folder into which students submit. nbgrader creates it when it releases the first assignment.

    Raises:
        OSError: the folder cannot be read.
    """
    if not inbound.exists():
        return
    for entry in sorted(os.scandir(inbound), key=lambda item: item.name):
        student, separator, suffix = entry.name.partition("+")
        try:
            status = entry.stat(follow_symlinks=False)
            owner = pwd.getpwuid(status.st_uid)
        except (OSError, KeyError):  # it was removed, only its student can access it, or the user does not exist
            continue
        if not separator or not stat.S_ISDIR(status.st_mode) or not os.path.lexists(Path(entry.path, LAST_FILE)):
            continue
        if owner.pw_name == student:
            # A student could forge the time in the name, but not this one.
            at = datetime.fromtimestamp(status.st_ctime, timezone.utc)
            assignment = suffix.partition("+")[0]
            yield ExchangeSubmission(Path(entry.path), student, owner.pw_uid, owner.pw_gid, assignment, at)


def in_turns(submissions: Iterable[ExchangeSubmission]) -> list[ExchangeSubmission]:
    """Return the first submission of each student, then the second of each, and so on."""
    counts: Counter[str] = Counter()

    def turn(submission: ExchangeSubmission) -> int:
        counts[submission.student] += 1
        return counts[submission.student]

    return sorted(submissions, key=turn)


def pack(submission: ExchangeSubmission) -> bytes:
    """Return a submission as an archive.

    Raises:
        UsageError: it is too large, or cannot be packed.
    """
    is_root, deadline = os.geteuid() == 0, time.monotonic() + MAX_PACK_SECONDS
    with subprocess.Popen(
        ["tar", "--create", "--directory", str(submission.folder), "."],
        cwd="/",  # tar changes to `--directory` as the student
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env={"PATH": os.defpath},
        user=submission.user if is_root else None,
        group=submission.group if is_root else None,
        extra_groups=[] if is_root else None,
    ) as tar:
        assert tar.stdout is not None
        try:
            data = _compressed(tar.stdout.fileno(), deadline)
            exit_status = tar.wait(max(0.0, deadline - time.monotonic()))
        except (TimeoutError, subprocess.TimeoutExpired):
            raise UsageError(f"it could not be packed within {MAX_PACK_SECONDS:.0f} s") from None
        finally:
            tar.kill()
    if exit_status != 0:
        raise UsageError(f"tar ended with {exit_status}")
    return data


def _compressed(pipe: int, deadline: float) -> bytes:
    """Read a pipe to its end, and return its compressed bytes.

    Raises:
        UsageError: there are too many bytes, before or after the compression.
        TimeoutError: it does not end before the deadline.
    """
    os.set_blocking(pipe, False)  # another process of the student may read a byte that has just arrived
    compressor, data, size = zlib.compressobj(wbits=_GZIP), bytearray(), 0
    with selectors.DefaultSelector() as selector:
        selector.register(pipe, selectors.EVENT_READ)
        while (remaining_seconds := deadline - time.monotonic()) > 0:
            selector.select(remaining_seconds)
            try:
                chunk = os.read(pipe, 65536)
            except BlockingIOError:
                continue
            size += len(chunk)
            data += compressor.compress(chunk) if chunk else compressor.flush()
            if size > MAX_READ_BYTES:
                raise UsageError(f"its files are larger than {MAX_READ_BYTES // 2**20} MiB in all")
            if len(data) > MAX_ANSWER:
                raise UsageError(f"its archive is larger than {MAX_ANSWER // 2**20} MiB")
            if not chunk:
                return bytes(data)
    raise TimeoutError


class Exchange:
    """Hands in new submissions from the exchange, under the same rules as those from notebooks."""

    def __init__(self, service: Service, inbound: Path) -> None:
        self._service, self._inbound = service, inbound
        self._logged_texts: set[str] = set()  # folders and sentences that are already in the log

    async def watch(self) -> None:
        """Poll the exchange until the process ends."""
        while True:
            try:
                await self.hand_in_all(await asyncio.to_thread(lambda: list(find_submissions(self._inbound))))
            except (OSError, sqlite3.Error) as error:
                if (sentence := f"{self._inbound}: {error}") not in self._logged_texts:
                    self._logged_texts.add(sentence)
                    LOG.warning("%s", sentence)
            await asyncio.sleep(POLL_SECONDS)

    async def hand_in_all(self, submissions: Iterable[ExchangeSubmission]) -> None:
        """Hand in the new submissions. If one cannot be packed, its student waits for the next poll."""
        waiting_students: set[str] = set()
        for submission in in_turns(submissions):
            if submission.student not in waiting_students and not await self._hand_in(submission):
                waiting_students.add(submission.student)

    async def _hand_in(self, submission: ExchangeSubmission) -> bool:
        """Hand in a submission if it is new and the rules allow it. Return False if it could not be packed."""
        service, name = self._service, submission.folder.name
        if submission.assignment not in service.settings.assignments or name in self._logged_texts:
            return True
        if service.store.with_key(submission.student, submission.key) is not None:
            return True
        try:
            service.require_try_left(submission.student, submission.assignment, submission.at)
            answer = await asyncio.to_thread(pack, submission)
        except (Refused, UsageError, OSError) as error:
            self._logged_texts.add(name)
            LOG.warning("%s in the exchange is not graded: %s", name, getattr(error, "sentence", error))
            return isinstance(error, Refused)
        service.store.receive(submission.student, submission.assignment, submission.key, answer, submission.at)
        await service.grader.notify()
        return True
