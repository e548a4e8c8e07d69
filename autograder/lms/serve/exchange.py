"""Hands in the submissions that students make through nbgrader's exchange.

A submission is a folder STUDENT+ASSIGNMENT+TIME+RANDOM in the course's folder of the exchange. The student owns it and
can still change it. Therefore, a process that runs as the student packs it, without following links.
"""

from __future__ import annotations

import asyncio
import hashlib
import logging
import os
import pwd
import sqlite3
import stat
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime, timezone
from pathlib import Path
from threading import Timer

from autograder.exceptions import UsageError
from autograder.lms.serve.shared import Refused, Service
from autograder.notebook.handing_in import MAX_ANSWER

LOG = logging.getLogger(__name__)
LAST_FILE = "submission_secret.txt"  # nbgrader writes it after all others
POLL_SECONDS = 5.0  # real time between two polls of the exchange
MAX_PACK_SECONDS = 60.0  # real time in which `tar` has to pack a submission


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
        """The key of its hand-in, which is the same in each poll, so that it is handed in only once."""
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
        status = entry.stat(follow_symlinks=False)
        if not separator or not stat.S_ISDIR(status.st_mode) or not os.path.lexists(Path(entry.path, LAST_FILE)):
            continue
        try:
            owner = pwd.getpwuid(status.st_uid)
        except KeyError:
            continue
        if owner.pw_name == student:
            # A student could forge the time in the name, but not this one.
            at = datetime.fromtimestamp(status.st_ctime, timezone.utc)
            assignment = suffix.partition("+")[0]
            yield ExchangeSubmission(Path(entry.path), student, owner.pw_uid, owner.pw_gid, assignment, at)


def pack(submission: ExchangeSubmission) -> bytes:
    """Return a submission as an archive.

    Raises:
        UsageError: it is too large, or cannot be packed.
    """
    is_root = os.geteuid() == 0
    with subprocess.Popen(
        ["tar", "--create", "--gzip", "--directory", str(submission.folder), "."],
        cwd="/",  # tar changes to `--directory` as the student
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env={"PATH": os.defpath},
        user=submission.user if is_root else None,
        group=submission.group if is_root else None,
        extra_groups=[] if is_root else None,
    ) as tar:
        assert tar.stdout is not None
        timer = Timer(MAX_PACK_SECONDS, tar.kill)
        timer.start()
        try:
            data = tar.stdout.read(MAX_ANSWER + 1)
            if len(data) > MAX_ANSWER:
                tar.kill()
        finally:
            tar.stdout.close()
            exit_status = tar.wait()
            timer.cancel()
    if len(data) > MAX_ANSWER:
        raise UsageError(f"its archive is larger than {MAX_ANSWER // 2**20} MiB")
    if exit_status != 0:
        raise UsageError(f"tar ended with {exit_status}")
    return data


class Exchange:
    """Hands in new submissions from the exchange, under the same rules as those from notebooks."""

    def __init__(self, service: Service, inbound: Path) -> None:
        self._service, self._inbound = service, inbound
        self._logged_texts: set[str] = set()  # folders and sentences that are already in the log

    async def watch(self) -> None:
        """Poll the exchange until the process ends."""
        while True:
            try:
                for submission in await asyncio.to_thread(lambda: list(find_submissions(self._inbound))):
                    await self._hand_in(submission)
            except (OSError, sqlite3.Error) as error:
                if (sentence := f"{self._inbound}: {error}") not in self._logged_texts:
                    self._logged_texts.add(sentence)
                    LOG.warning("%s", sentence)
            await asyncio.sleep(POLL_SECONDS)

    async def _hand_in(self, submission: ExchangeSubmission) -> None:
        service, name = self._service, submission.folder.name
        if submission.assignment not in service.settings.assignments or name in self._logged_texts:
            return
        if service.store.with_key(submission.student, submission.key) is not None:
            return
        try:
            service.require_try_left(submission.student, submission.assignment, submission.at)
            answer = await asyncio.to_thread(pack, submission)
        except (Refused, UsageError, OSError) as error:
            self._logged_texts.add(name)
            LOG.warning("%s in the exchange is not graded: %s", name, getattr(error, "sentence", error))
            return
        service.store.receive(submission.student, submission.assignment, submission.key, answer, submission.at)
        await service.grader.notify()
