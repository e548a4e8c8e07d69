"""A cluster gives the same results as one machine, each exactly once, whichever process is killed."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from autograder.author.verification.mutants import mutants, write_mutant, write_reference
from autograder.diagnosis import Diagnosis, Kind
from autograder.grade.cluster import dispatch
from autograder.grade.cluster.connection import LOCAL, connected
from autograder.grade.cluster.dispatch import grade_on
from autograder.grade.cluster.exceptions import ClusterError
from autograder.grade.cluster.machine import resource
from autograder.grade.cluster.task import Reply, Task
from autograder.grade.job import Job
from autograder.grade.pipeline import unclear_result
from autograder.result.model import Result, Status
from autograder.run.sandbox import Isolation
from autograder.submission.intake import detect_layout
from autograder.suite import suites
from tests.e2e.local_cluster import CLIENT, SCHEDULER, WORKERS, LocalCluster, local_cluster
from tests.e2e.results import without_times

ASSIGNMENT = "01_package_structure"
DEADLINE = 1500.0  # seconds

pytestmark = [pytest.mark.slow, pytest.mark.timeout(3600)]


def write_class(folder: Path, flawed: int) -> list[str]:
    """Write a class: the reference, flawed answers, and two unclear submissions. Return the students."""
    sources = suites.hidden(ASSIGNMENT).sources
    write_reference(sources, folder / "reference")
    for mutant in [mutant for mutant in mutants(ASSIGNMENT) if not mutant.slow][:flawed]:
        write_mutant(mutant, sources, folder / mutant.id)
    (folder / "no package" / "src").mkdir(parents=True)
    (folder / "no package" / "src" / "notes.txt").write_text("later")
    (folder / "Zoë Ünïcode.zip").write_bytes(b"not an archive")
    return sorted(path.stem for path in folder.iterdir())


def grade_command(out: str, *options: str) -> list[str]:
    command = [sys.executable, "-m", "autograder", "grade", "class", "--assignment", ASSIGNMENT, "--out", out]
    return [*command, "--json", f"{out}.json", *options]


def stored_results(out: Path) -> dict[str, tuple[Any, dict[str, bytes]]]:
    """Return each student's result without times, and the files of its pictures."""
    results = {}
    for path in sorted(out.glob("*/result.json")):
        pictures = [file for pattern in ("*.png", "*.run.json") for file in path.parent.glob(pattern)]
        results[path.parent.name] = (
            without_times(json.loads(path.read_text())),
            {file.name: file.read_bytes() for file in pictures},
        )
    return results


def grade_during_kills(cluster: LocalCluster, kills: int, draw: random.Random) -> Path:
    """Grade the class, repeatedly if need be, until `kills` machines have been killed; return the last results."""
    victims = [CLIENT, SCHEDULER, *WORKERS]
    deadline, attempt, killed = time.monotonic() + DEADLINE, 0, 0
    options = ("--scheduler", cluster.address, "--certificates", str(cluster.certificates), "--resume")
    cluster.restart_ended()
    client = cluster.run(CLIENT, grade_command(f"out{attempt}", *options))
    while time.monotonic() < deadline:
        try:
            client.wait(draw.uniform(0.5, 8.0) if killed < kills else deadline - time.monotonic())
        except subprocess.TimeoutExpired:
            cluster.kill(draw.choice(victims) if killed >= 3 else (WORKERS[0], SCHEDULER, CLIENT)[killed])
            killed += 1
        cluster.restart_ended()
        if client.poll() is None:
            continue
        # The file is written at the end. The status is 1, because two submissions are unclear.
        if (cluster.client_folder / f"out{attempt}.json").is_file():
            if killed >= kills:
                return cluster.client_folder / f"out{attempt}"
            attempt += 1
        client = cluster.run(CLIENT, grade_command(f"out{attempt}", *options))
    raise AssertionError(f"not graded within {DEADLINE} s, after {killed} kills:\n{cluster.log(CLIENT)[-3000:]}")


@pytest.mark.promise(
    ".venv/bin/dask scheduler",
    ".venv/bin/dask worker",
    ".venv/bin/autograder grade submissions/ --assignment 02_nodes --scheduler tls://SCHEDULER:8786",
    "| A worker dies. |",
    "| The scheduler dies, or the client. |",
    "Nothing else changes: the verb, the results, `--resume` and Ctrl-C are the same.",
    "Workers cannot see the client's folders.",
    "The commands above are tested with a scheduler and three workers",
    "A large class can be graded on [many machines]",
    "A large class can be graded [on many machines]",
)
@pytest.mark.parametrize(
    ("kills", "flawed"), [pytest.param(3, 0, id="3"), pytest.param(20, 8, id="20", marks=pytest.mark.nightly)]
)
def test_a_class_survives_kills_of_workers_scheduler_and_client(tmp_path: Path, kills: int, flawed: int) -> None:
    with local_cluster(tmp_path) as cluster:
        students = write_class(cluster.client_folder / "class", flawed)
        serial = subprocess.run(grade_command("serial", "-j", "1"), cwd=cluster.client_folder, check=False)
        assert serial.returncode == 1
        seed = int(os.environ.get("KILLS_SEED", 2026 if kills == 3 else time.time_ns() % 100_000))
        print(f"KILLS_SEED={seed}")  # repeats the kills at the same times
        out = grade_during_kills(cluster, kills, random.Random(seed))
        listed = [result["student"] for result in json.loads((cluster.client_folder / f"{out.name}.json").read_text())]
        assert sorted(listed) == students
        assert stored_results(out) == stored_results(cluster.client_folder / "serial")
        assert set(stored_results(out)) == set(students)


@pytest.fixture
def jobs(tmp_path: Path) -> list[Job]:
    """Three different submissions to grade."""
    jobs = []
    for student in ("alice", "bob", "carol"):
        package = tmp_path / student / "src" / "package"
        package.mkdir(parents=True)
        (package / "package.xml").write_text(student)
        jobs.append(Job(tmp_path / student, ASSIGNMENT, student, 7, tmp_path / "out" / student, Isolation.PROCESS))
    return jobs


def reply_without_grading(data: bytes) -> bytes:
    """Reply as a worker does, but without grading; at bob's submission, the worker dies."""
    task = Task.unpack(data)
    if task.files[0].data == b"bob":
        os.kill(os.getpid(), signal.SIGKILL)
    result = replace(
        unclear_result(task.job, Diagnosis(Kind.BUILD_FAILED, "no")),
        submission_sha256=detect_layout(list(task.files), ASSIGNMENT).sha256,
        status=Status.GRADED,
    )
    return Reply({"result.json": json.dumps(result.to_json()).encode()}).pack()


@pytest.mark.promise("| Two workers die with the same submission. |")
def test_a_submission_that_kills_two_workers_is_not_graded_and_the_others_are(jobs: list[Job], tmp_path: Path) -> None:
    with connected(LOCAL, 1, tmp_path) as client:
        results: list[Result] = []
        grade_on(client, jobs, results.append, report=pytest.fail, grade=reply_without_grading)
        alice, bob, carol = sorted(results, key=lambda result: result.student)
    assert (alice.status, bob.status, carol.status) == (Status.GRADED, Status.NOT_GRADED, Status.GRADED)
    assert bob.diagnosis.sentence.startswith("2 workers died while they graded this submission. This is not a zero")
    assert "KilledWorker" in (jobs[1].out / "grader.log").read_text()


@pytest.mark.promise(
    "It gets no submissions, and the client says what differs.", "| No worker is suitable for two minutes. |"
)
def test_a_worker_with_another_suite_is_rejected_and_gets_no_submission(
    jobs: list[Job], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    graded: list[Result] = []
    reports: list[str] = []
    other_resource = resource(ASSIGNMENT, Isolation.PROCESS).replace(suites.hidden(ASSIGNMENT).files_digest, "another")
    with connected(LOCAL, 1, tmp_path) as client:
        monkeypatch.setattr(dispatch, "resource", lambda assignment, isolation: other_resource)
        monkeypatch.setattr(dispatch, "NO_WORKER_TIMEOUT_SECONDS", 0.0)
        with pytest.raises(ClusterError, match="no suitable worker was available"):
            grade_on(client, jobs, graded.append, report=reports.append, grade=reply_without_grading)
    assert graded == []
    (sentence,) = reports
    assert f"is rejected: its suite of {ASSIGNMENT} is" in sentence
    assert sentence.endswith("but here it is another: install the same version of the course on both.")


@pytest.mark.promise(
    "`--scheduler local` starts such a cluster on this machine",
    "Nothing else changes: the verb, the results, `--resume` and Ctrl-C are the same.",
)
def test_ctrl_c_keeps_the_gradings_that_have_started_and_resume_grades_the_rest(tmp_path: Path) -> None:
    for student in ("alice", "bob", "carol"):
        (tmp_path / "class" / student / "src").mkdir(parents=True)
        (tmp_path / "class" / student / "src" / "notes.txt").write_text(student)
    command = grade_command("out", "--scheduler", "local", "-j", "1", "--resume")
    with subprocess.Popen(
        command,
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
        env={**os.environ, "PYTHONUNBUFFERED": "1"},
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline().startswith("[1/3]")
        os.killpg(process.pid, signal.SIGINT)  # like a terminal, which also signals the workers
        reports = process.stdout.read()
    assert process.returncode == 130, reports
    assert reports.endswith("\nStopped. Finished results are in out: the same command with --resume grades the rest.\n")
    finished = {
        student: (tmp_path / "out" / student / "result.json").stat().st_mtime_ns
        for student in stored_results(tmp_path / "out")
    }
    assert 1 <= len(finished) < 3
    subprocess.run(command, cwd=tmp_path, check=True)
    assert len(stored_results(tmp_path / "out")) == 3
    assert all(json.loads(path.read_text())["status"] == "graded" for path in tmp_path.glob("out/*/result.json"))
