"""A worker's reply is checked as untrusted input: an invalid one is rejected, and nothing is written."""

from __future__ import annotations

import io
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path, PurePosixPath
from typing import Any

import msgpack
import pytest
from PIL import Image

from autograder.exceptions import StudentError
from autograder.grade.cluster.accept import accept
from autograder.grade.cluster.exceptions import ClusterError
from autograder.grade.cluster.task import MAX_REPLY, Reply, Task
from autograder.grade.job import Job
from autograder.grade.pipeline import not_graded_result, unclear_result
from autograder.grade.reply import ReplyError
from autograder.grade.store import write_result
from autograder.result.model import Artifact, CheckResult, Result, Status
from autograder.run.sandbox import Isolation
from autograder.submission.intake import SubmittedFile, read_submission
from autograder.suite import Outcome, suites

CHAPTER = "02_nodes"
SHA256 = "a" * 64


@pytest.fixture
def job(tmp_path: Path) -> Job:
    return Job(tmp_path / "submission", CHAPTER, "Zoë", 7, tmp_path / "out")


@pytest.fixture
def result(make_result: Callable[..., Result]) -> Result:
    suite = suites.hidden(CHAPTER)
    checks = tuple(CheckResult.of(check, Outcome.PASSED) for check in suite.checks)
    versions = {"suite_version": suite.version, "files_digest": suite.files_digest, "submission_sha256": SHA256}
    return make_result("", checks=checks, max_score=suite.max_score, **versions)


def png() -> bytes:
    out = io.BytesIO()
    Image.new("RGB", (8, 8)).save(out, "PNG")
    return out.getvalue()


def answer(result: Result, **files: bytes) -> bytes:
    return Reply({"result.json": json.dumps(result.to_json()).encode(), **files}).pack()


def with_picture(result: Result, name: str) -> Result:
    return replace(result, artifacts=(Artifact(name, "track", SHA256, "turns"),))


def with_run(result: Result, name: str) -> Result:
    return replace(result, artifacts=(Artifact("turns.png", "track", SHA256, "turns", run=name),))


@pytest.mark.promise("A submission is sent as its files")
def test_packing_and_unpacking_a_task_preserves_any_file_name() -> None:
    names = ("src/a b/ü.py", "src/\udcff.txt", "run")
    files = tuple(SubmittedFile(PurePosixPath(name), name.encode("utf-8", "replace"), name == "run") for name in names)
    job = Job(Path(), CHAPTER, "", 7, Path(), Isolation.PROCESS)
    task = Task(job, files)
    assert Task.unpack(task.pack()).job == job
    assert set(Task.unpack(task.pack()).files) == set(files)
    assert Task(job, files[::-1]).pack() == task.pack()


@pytest.mark.parametrize(
    "data",
    [b"", b"\xc1", msgpack.packb(["02_nodes", 7, "no isolation", []]), msgpack.packb(["02_nodes", 7, "process", [[]]])],
)
def test_bytes_that_are_not_a_task_are_rejected(data: bytes) -> None:
    with pytest.raises(ClusterError, match="a task cannot be read"):
        Task.unpack(data)


@pytest.mark.parametrize("name", ["/etc/passwd", "src/../../x"])
def test_a_task_writes_no_file_outside_its_folder(job: Job, name: str) -> None:
    data = Task(job, (SubmittedFile(PurePosixPath(name), b""),)).pack()
    with pytest.raises(ClusterError, match="names a file outside of the submission"):
        Task.unpack(data)


@pytest.mark.promise("The student's name stays with the client.")
def test_a_reply_is_stored_under_the_student_s_name(job: Job, result: Result) -> None:
    reported = with_run(result, "turns.run.json")
    accepted = accept(answer(reported, **{"turns.png": png(), "turns.run.json": b"{}"}), job, SHA256)
    assert accepted == replace(reported, student="Zoë")
    assert json.loads((job.out / "result.json").read_text())["student"] == "Zoë"
    assert (job.out / "turns.png").read_bytes() == png()
    assert (job.out / "turns.run.json").read_bytes() == b"{}"


def hostile(result: Result) -> dict[str, tuple[object, str]]:
    first, *rest = result.checks
    zeroed = [replace(check, points=0.0) for check in rest]
    picture = {"turns.png": png()}
    large = io.BytesIO()
    Image.new("1", (6000, 6000)).save(large, "PNG")
    return {
        "no bytes": ({"result.json": ""}, "sent dict instead of bytes"),
        "no msgpack": (b"\xc1", "cannot be read"),
        "too large": (b"\x00" * (MAX_REPLY + 1), "at most"),
        "nested": (b"\x91" * 100_000, "cannot be read"),
        "empty lists": (msgpack.packb([{"result.json": [[]] * 100_000}, ""]), "cannot be read"),
        "empty maps": (msgpack.packb([{"result.json": {"a": {"b": {}}}}, ""]), "cannot be read"),
        "a missing file": (msgpack.packb([{"result.json": b""}, ""])[:-1], "cannot be read"),
        "an invalid name": (b"\x92\x81\x01\xc4\x00\xa0", "does not consist of named files"),
        "too many files": (msgpack.packb([{str(n): b"" for n in range(201)}, ""]), "does not consist of named files"),
        "no files": (msgpack.packb([[1], ""]), "cannot be read"),
        "no result": (Reply({}).pack(), "contains no result"),
        "no schema": (Reply({"result.json": b'{"score": 100}'}).pack(), "contains no result"),
        "another seed": (answer(replace(result, seed=8)), "a worker graded"),
        "another submission": (answer(replace(result, submission_sha256="b" * 64)), "a worker graded"),
        "another suite": (answer(replace(result, suite_version="0" * 12)), "a worker graded"),
        "other files": (answer(replace(result, files_digest="0" * 12)), "a worker graded"),
        "another maximum": (answer(replace(result, max_score=99.0)), "a worker graded"),
        "another isolation level": (answer(replace(result, isolation="process")), "a worker graded"),
        "a missing check": (answer(replace(result, checks=tuple(rest))), "does not contain the checks"),
        "a check worth more": (
            answer(replace(result, checks=(replace(first, max_points=99.0), *rest))),
            "does not contain the checks",
        ),
        "too many points": (
            answer(replace(result, checks=(replace(first, points=99.0), *rest))),
            f"points of {result.max_score:g}",
        ),
        "too many points for a check": (
            answer(replace(result, checks=(replace(first, points=first.max_points + 1), *zeroed))),
            "more points",
        ),
        "a file that is not a picture": (answer(result, **{"evil.sh": b"rm"}), "its result names"),
        "a picture outside": (answer(with_picture(result, "../x.png"), **{"../x.png": png()}), "of the name"),
        "an invalid picture": (
            answer(with_picture(result, "turns.png"), **{"turns.png": b"GIF"}),
            "cannot be read",
        ),
        "a missing picture": (answer(with_picture(result, "turns.png")), "its result names"),
        "an unnamed picture": (answer(result, **picture), "its result names"),
        "a huge picture": (answer(with_picture(result, "turns.png"), **{"turns.png": large.getvalue()}), "pixels"),
        "an invalid run": (
            answer(with_run(result, "turns.run.json"), **picture, **{"turns.run.json": b"[]"}),
            "it is not a run",
        ),
        "a run outside": (
            answer(with_run(result, "../x.run.json"), **picture, **{"../x.run.json": b"{}"}),
            "of the name",
        ),
        "no notebook": (answer(result, **{"notebook.ipynb": b"[]"}), "notebook in a worker's reply"),
        "a failure": (Reply({}, "Traceback: disk full").pack(), "the worker failed: Traceback: disk full"),
    }


@pytest.mark.promise("The client treats replies as untrusted.", "It writes nothing until the whole reply is valid.")
def test_a_hostile_reply_is_rejected_and_writes_nothing(job: Job, result: Result) -> None:
    for name, (data, reason) in hostile(result).items():
        with pytest.raises(ReplyError, match=reason):
            pytest.fail(f"{name}: {accept(data, job, SHA256)}")
        assert not job.out.exists(), name


def test_a_submission_that_is_given_up_is_not_graded_instead_of_zero(job: Job) -> None:
    given_up = write_result(
        job, *not_graded_result(job, "2 workers died while they graded this submission.", "KilledWorker\n")
    )
    assert given_up.status is Status.NOT_GRADED
    assert given_up.diagnosis.sentence.startswith("2 workers died while they graded this submission. This is not a")
    assert (job.out / "grader.log").read_text() == "KilledWorker\n"


def test_a_submission_that_intake_rejects_is_unclear_and_needs_no_worker(tmp_path: Path) -> None:
    (tmp_path / "bob.zip").write_bytes(b"none")
    with pytest.raises(StudentError) as excinfo:
        read_submission(tmp_path / "bob.zip", CHAPTER)
    result = unclear_result(Job(tmp_path / "bob.zip", CHAPTER, "bob", 7, tmp_path), excinfo.value.diagnosis)
    assert (result.status, result.score, result.diagnosis) == (Status.UNCLEAR, 0.0, excinfo.value.diagnosis)


@pytest.mark.promise("A reply is at most 64 MiB")
def test_a_reply_that_would_be_too_large_is_a_failure() -> None:
    files: dict[str, Any] = {"result.json": b"\x00" * (MAX_REPLY + 1)}
    assert "the grading wrote too much" in Reply.unpack(Reply(files).pack()).failure
