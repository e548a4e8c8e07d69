"""Submissions through nbgrader's exchange are taken once, for their owner, with the owner's rights."""

from __future__ import annotations

import asyncio
import os
import pwd
import tempfile
import time
from collections.abc import Iterator
from datetime import datetime, timezone
from pathlib import Path

import pytest

from autograder.exceptions import StudentError, UsageError
from autograder.lms.serve import exchange
from autograder.lms.serve.exchange import LAST_FILE, Exchange, ExchangeSubmission, find_submissions, pack
from autograder.lms.serve.grading import Grader, GradingOptions
from autograder.lms.serve.settings import AssignmentSettings, Settings
from autograder.lms.serve.shared import Service
from autograder.lms.serve.store import Store
from autograder.notebook.handing_in import MAX_ANSWER
from autograder.run.sandbox import Isolation
from autograder.submission import intake
from tests.unit.serve import serving
from tests.unit.serve.classroom import Classroom

STUDENT = pwd.getpwuid(os.geteuid()).pw_name
NOBODY = pwd.getpwnam("nobody")
MANIFEST = "ws/src/package/package.xml"
SETTINGS = """
instructors: [grace]
exchange: INBOUND
assignments:
  02_nodes: {tries_a_day: 2}
"""
needs_root = pytest.mark.skipif(os.geteuid() != 0, reason="only root can give a file to another user")


@pytest.fixture
def inbound() -> Iterator[Path]:
    """The folder into which students submit; other users can enter it."""
    with tempfile.TemporaryDirectory(dir="/tmp") as folder:
        root = Path(folder)
        root.chmod(0o755)
        (root / "inbound").mkdir()
        yield root / "inbound"


def submit(inbound: Path, random: str, student: str = STUDENT, assignment: str = "02_nodes") -> Path:
    """Submit an assignment as nbgrader does; return the folder."""
    folder = inbound / f"{student}+{assignment}+2026-05-04 09:00:00 UTC+{random}"
    (folder / MANIFEST).parent.mkdir(parents=True)
    (folder / MANIFEST).write_text(student)
    (folder / LAST_FILE).touch()
    return folder


def only_submission(inbound: Path) -> ExchangeSubmission:
    (submitted,) = find_submissions(inbound)
    return submitted


def test_a_submission_is_found_when_nbgrader_has_written_its_last_file(inbound: Path) -> None:
    assert list(find_submissions(inbound / "missing")) == []
    folder = submit(inbound, "r4nd0m")
    (folder / LAST_FILE).unlink()
    assert list(find_submissions(inbound)) == []
    (folder / LAST_FILE).touch()
    submitted = only_submission(inbound)
    assert (submitted.student, submitted.assignment, submitted.folder) == (STUDENT, "02_nodes", folder)


def test_a_submission_in_the_name_of_another_user_is_ignored(inbound: Path) -> None:
    submit(inbound, "r4nd0m", student="somebody-else")
    (inbound / f"{STUDENT}+02_nodes+link").symlink_to(submit(inbound, "own"))
    assert only_submission(inbound).folder.name.endswith("+own")


def test_an_entry_that_cannot_be_examined_does_not_hide_the_others(
    inbound: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Mounted:
        """A folder that only its student can access, such as a file system that the student has mounted."""

        name = f"{STUDENT}+02_nodes+mounted"

        def stat(self, *, follow_symlinks: bool) -> None:
            raise PermissionError

    folder = submit(inbound, "r4nd0m")
    entries = [Mounted(), *os.scandir(inbound)]
    with monkeypatch.context() as patch:
        patch.setattr(os, "scandir", lambda path: entries)
        assert only_submission(inbound).folder == folder


def test_a_packed_submission_is_read_like_an_answer_from_a_notebook(inbound: Path, tmp_path: Path) -> None:
    submit(inbound, "r4nd0m")
    (tmp_path / "answer.zip").write_bytes(pack(only_submission(inbound)))
    files = {str(file.path): file.data for file in intake.read_files(tmp_path / "answer.zip", "02_nodes")}
    assert files[MANIFEST] == STUDENT.encode()


def test_a_link_is_packed_as_a_link(inbound: Path, tmp_path: Path) -> None:
    folder = submit(inbound, "r4nd0m")
    (tmp_path / "secret").write_text("SECRET")
    (folder / MANIFEST).unlink()
    (folder / MANIFEST).symlink_to(tmp_path / "secret")
    (tmp_path / "answer.zip").write_bytes(pack(only_submission(inbound)))
    with pytest.raises(StudentError, match="link"):
        intake.read_files(tmp_path / "answer.zip", "02_nodes")


@needs_root
def test_a_file_that_its_student_cannot_read_is_not_packed(inbound: Path) -> None:
    folder = submit(inbound, "r4nd0m", student=NOBODY.pw_name)
    for path in (folder, *folder.rglob("*")):
        os.chown(path, NOBODY.pw_uid, NOBODY.pw_gid)
    assert pack(only_submission(inbound))
    (folder / "hard link").write_text("SECRET")  # owned by root, and unreadable for others
    (folder / "hard link").chmod(0o600)
    with pytest.raises(UsageError, match="tar ended with 2"):
        pack(only_submission(inbound))


def test_a_submission_that_is_too_large_is_refused(inbound: Path) -> None:
    (submit(inbound, "r4nd0m") / "noise").write_bytes(os.urandom(MAX_ANSWER + 1))
    with pytest.raises(UsageError, match="its archive is larger than 16 MiB"):
        pack(only_submission(inbound))


def test_more_data_than_intake_reads_are_refused_before_they_are_all_read(
    inbound: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(exchange, "MAX_READ_BYTES", 2**20)
    with (submit(inbound, "r4nd0m") / "holes").open("wb") as file:
        file.truncate(3 * 2**30)
    sizes: list[int] = []

    def read(descriptor: int, size: int) -> bytes:
        data = original(descriptor, size)
        sizes.append(len(data))
        return data

    original = os.read
    submitted = only_submission(inbound)
    monkeypatch.setattr(os, "read", read)
    with pytest.raises(UsageError, match="its files are larger than 1 MiB in all"):
        pack(submitted)
    assert 2**20 < sum(sizes) < 2**21


def test_a_fifo_is_packed_without_being_opened(inbound: Path) -> None:
    os.mkfifo(submit(inbound, "r4nd0m") / "fifo")
    assert pack(only_submission(inbound))


def test_a_submission_that_is_not_packed_in_time_is_refused(inbound: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    submit(inbound, "r4nd0m")
    monkeypatch.setattr(exchange, "MAX_PACK_SECONDS", 0.0)
    with pytest.raises(UsageError, match="it could not be packed within 0 s"):
        pack(only_submission(inbound))


def test_a_pipe_that_another_process_keeps_open_is_read_until_the_deadline() -> None:
    """The student can open the pipe of a process that runs as the student."""
    reader, writer = os.pipe()
    os.write(writer, b"x")
    try:
        with pytest.raises(TimeoutError):
            exchange._compressed(reader, time.monotonic() + 0.2)
    finally:
        os.close(reader)
        os.close(writer)


def test_a_student_with_submissions_that_cannot_be_packed_does_not_delay_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    packed_names: list[str] = []

    def pack_or_refuse(submission: ExchangeSubmission) -> bytes:
        packed_names.append(submission.folder.name)
        if submission.student == "eve":
            raise UsageError("it could not be packed within 60 s")
        return b""

    monkeypatch.setattr(exchange, "pack", pack_or_refuse)
    settings, store = Settings({"02_nodes": AssignmentSettings()}), Store(tmp_path)
    at = datetime(2026, 10, 5, tzinfo=timezone.utc)
    submissions = [
        ExchangeSubmission(Path(f"{student}+{number}"), student, 0, 0, "02_nodes", at)
        for student in ("eve", "zoe")
        for number in range(3)
    ]

    async def polls() -> None:
        grader = Grader(settings, store, GradingOptions(1, 0, Isolation.PROCESS))
        service = Service(settings, store, grader, "/")
        own_exchange = Exchange(service, tmp_path)
        for _ in range(2):
            await own_exchange.hand_in_all(submissions)

    asyncio.run(polls())
    assert packed_names == ["eve+0", "zoe+0", "zoe+1", "zoe+2", "eve+1"]
    assert {hand_in.student for hand_in in store.waiting()} == {"zoe"}
    store.close()


def test_submissions_are_graded_once_and_by_the_rules_of_the_settings(classroom: Classroom, inbound: Path) -> None:
    classroom.settings = SETTINGS.replace("INBOUND", str(inbound))
    for number in range(3):  # one more than the tries of a day
        submit(inbound, f"r{number}")
    submit(inbound, "other", assignment="03_interfaces")
    classroom.start()
    order = classroom.folder / serving.ORDER
    classroom.wait(lambda: order.exists() and len(order.read_text().split()) == 2)
    classroom.wait_for_marks(1)
    classroom.kill()
    classroom.start()
    classroom.wait(classroom.listens)
    submit(inbound, "late")
    classroom.wait(lambda: "53 of 53" in classroom.get(STUDENT)[1])
    assert order.read_text().split() == [STUDENT] * 2
