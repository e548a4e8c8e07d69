"""Takes what students submit through nbgrader's exchange.

A submission is a folder STUDENT+ASSIGNMENT+TIME+RANDOM among those of the course. Its student made it, and can still
change it. Therefore a process with the student's own rights packs it, and packs a link as a link.
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
LAST = "submission_secret.txt"  # the file that nbgrader writes after all others
LOOK_SECONDS = 5.0  # between two looks
PACK_SECONDS = 60.0  # to pack a submission


@dataclass(frozen=True)
class Submitted:
    """A submission in the exchange: its folder, its student, who owns it, and since when it is complete."""

    folder: Path
    student: str
    user: int
    group: int
    assignment: str
    at: datetime

    @property
    def key(self) -> str:
        """The key of its hand-in: each submission is handed in once."""
        return hashlib.sha256(self.folder.name.encode()).hexdigest()[:32]


def find(inbound: Path) -> Iterator[Submitted]:
    """Yield the complete submissions of users of this machine. One in another's name is not a submission.

    Args:
        inbound: the folder into which students submit. It exists once an assignment has been released.

    Raises:
        OSError: the folder cannot be read.
    """
    if not inbound.exists():
        return
    for entry in sorted(os.scandir(inbound), key=lambda each: each.name):
        student, plus, rest = entry.name.partition("+")
        about = entry.stat(follow_symlinks=False)
        if not plus or not stat.S_ISDIR(about.st_mode) or not os.path.lexists(Path(entry.path, LAST)):
            continue
        try:
            owner = pwd.getpwuid(about.st_uid)
        except KeyError:
            continue
        if owner.pw_name == student:
            # The time in the name is the student's own word; this one is the system's.
            at = datetime.fromtimestamp(about.st_ctime, timezone.utc)
            assignment = rest.partition("+")[0]
            yield Submitted(Path(entry.path), student, owner.pw_uid, owner.pw_gid, assignment, at)


def pack(submitted: Submitted) -> bytes:
    """Return a submission as an archive.

    Raises:
        UsageError: it is too large, or cannot be packed.
    """
    is_root = os.geteuid() == 0
    with subprocess.Popen(
        ["tar", "--create", "--gzip", "--directory", str(submitted.folder), "."],
        cwd="/",  # `--directory` is entered with the student's rights
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env={"PATH": os.defpath},
        user=submitted.user if is_root else None,
        group=submitted.group if is_root else None,
        extra_groups=[] if is_root else None,
    ) as tar:
        assert tar.stdout is not None
        deadline = Timer(PACK_SECONDS, tar.kill)
        deadline.start()
        try:
            data = tar.stdout.read(MAX_ANSWER + 1)
            if len(data) > MAX_ANSWER:
                tar.kill()
        finally:
            tar.stdout.close()
            status = tar.wait()
            deadline.cancel()
    if len(data) > MAX_ANSWER:
        raise UsageError(f"its archive is larger than {MAX_ANSWER // 2**20} MiB")
    if status != 0:
        raise UsageError(f"tar ended with {status}")
    return data


class Exchange:
    """Hands in what appears in the exchange, by the same rules as what comes from notebooks."""

    def __init__(self, service: Service, inbound: Path) -> None:
        self._service, self._inbound = service, inbound
        self._said: set[str] = set()  # lines that are already in the log

    async def watch(self) -> None:
        """Look again and again for as long as the process lives."""
        while True:
            try:
                for submitted in await asyncio.to_thread(lambda: list(find(self._inbound))):
                    await self._take(submitted)
            except (OSError, sqlite3.Error) as error:
                self._say(f"{self._inbound}: {error}")
            await asyncio.sleep(LOOK_SECONDS)

    async def _take(self, submitted: Submitted) -> None:
        service, name = self._service, submitted.folder.name
        if submitted.assignment not in service.settings.assignments or name in self._said:
            return
        if service.store.with_key(submitted.student, submitted.key) is not None:
            return
        try:
            service.require_a_try(submitted.student, submitted.assignment, submitted.at)
            answer = await asyncio.to_thread(pack, submitted)
        except (Refused, UsageError, OSError) as error:
            self._said.add(name)
            LOG.warning("%s in the exchange is not graded: %s", name, getattr(error, "sentence", error))
            return
        service.store.receive(submitted.student, submitted.assignment, submitted.key, answer, submitted.at)
        await service.grader.notify()

    def _say(self, sentence: str) -> None:
        if sentence not in self._said:
            self._said.add(sentence)
            LOG.warning("%s", sentence)
