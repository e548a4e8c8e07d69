"""Measure the overhead of a cluster. A pause and a reply of usual size replace each grading."""

from __future__ import annotations

import json
import tempfile
import time
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from distributed import Client

from autograder.diagnosis import Diagnosis, Kind
from autograder.grade.cluster.connection import LOCAL, connected
from autograder.grade.cluster.dispatch import grade_on
from autograder.grade.cluster.task import Reply, Task
from autograder.grade.job import Job
from autograder.grade.pipeline import unclear_result
from autograder.result.model import Result
from autograder.run.sandbox import Isolation
from autograder.submission.intake import detect_layout

ASSIGNMENT = "02_nodes"
SUBMISSIONS, THREADS = 400, 16
SOURCE = "x = 1\n" * 4000  # 24 kB, the size of an answer to 02


def figures() -> dict[str, float]:
    """Return the overhead per submission in milliseconds, measured with gradings that take no time."""
    with connected(LOCAL, THREADS, Path()) as client:
        elapsed, _ = time_class(client, SUBMISSIONS, [0.0])
    return {"cluster.overhead_ms": round(1000 * elapsed / SUBMISSIONS, 2)}


def time_class(client: Client, submissions: int, pauses: Sequence[float]) -> tuple[float, float]:
    """Return the seconds that a class takes on a cluster, and the sum of the submissions' pauses."""
    with tempfile.TemporaryDirectory() as name:
        jobs = [_job(Path(name), number) for number in range(submissions)]
        # The first grading imports modules, so it is not measured.
        grade_on(client, jobs[:1], lambda _: None, report=print, grade=partial(_reply, [0.0]))
        start = time.monotonic()
        results: list[Result] = []
        grade_on(client, jobs, results.append, report=print, grade=partial(_reply, pauses))
        elapsed = time.monotonic() - start
    assert len({result.submission_sha256 for result in results}) == submissions
    return elapsed, sum(result.seconds for result in results)


def _job(folder: Path, number: int) -> Job:
    source = folder / "class" / str(number) / "src" / "package"
    source.mkdir(parents=True)
    (source / "package.xml").write_text(str(number))
    (source / "node.py").write_text(SOURCE)
    return Job(source.parents[1], ASSIGNMENT, str(number), 7, folder / "out" / str(number), Isolation.PROCESS)


def _reply(pauses: Sequence[float], data: bytes) -> bytes:
    task = Task.unpack(data)
    sha256 = detect_layout(list(task.files), ASSIGNMENT).sha256
    pause = pauses[int(sha256, 16) % len(pauses)]
    time.sleep(pause)
    result = unclear_result(task.job, Diagnosis(Kind.BUILD_FAILED, "no", "x" * 4000))
    reply_json = replace(result, submission_sha256=sha256, seconds=pause).to_json()
    return Reply({"result.json": json.dumps(reply_json).encode()}).pack()
