"""Submissions that share a worker sandbox get the same results as with a sandbox each."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import tempfile
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from autograder.author.verification.mutants import write_reference
from autograder.author.verification.worker_pool import WorkerPool
from autograder.diagnosis import Kind
from autograder.grade import grade_submission
from autograder.grade.job import WHOLE_SUITE, Job, Options
from autograder.grade.own_sandbox import run_in_own_sandbox
from autograder.grade.pipeline import RunJob
from autograder.grade.store import LOG
from autograder.result.model import Result, Status
from autograder.run.sandbox import Isolation, procfs
from autograder.suite import Outcome

ASSIGNMENT = "02_nodes"
PACKAGE = "my_robot_package"
Servers = Callable[[], list[int]]
SOME_CHECKS = Options(only=("starts", "node_name", "subscribes_scan", "publishes_cmd_vel", "threshold"))


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("reference") / "tree"
    write_reference((PACKAGE,), folder)
    return folder


@pytest.fixture(scope="module")
def incomplete_submission(reference: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A submission that is graded quickly: a package without setup.py."""
    folder = tmp_path_factory.mktemp("incomplete") / "tree"
    shutil.copytree(reference, folder)
    (folder / "src" / PACKAGE / "setup.py").unlink()
    return folder


def _grade(
    path: Path, out: Path, workers: RunJob, options: Options = WHOLE_SUITE, isolation: Isolation = Isolation.BUBBLEWRAP
) -> Result:
    return grade_submission(Job(path, ASSIGNMENT, "s", 3, out, isolation, options), workers)


def _verdicts(result: Result) -> list[tuple[object, ...]]:
    return [(check.id, check.outcome, check.message, check.points) for check in result.checks]


def _fork_servers() -> set[int]:
    """Return the fork servers that are children of this process."""
    servers = set()
    for task in Path("/proc/self/task").iterdir():
        with contextlib.suppress(OSError):  # the thread or the child has ended
            for child in (task / "children").read_text().split():
                if "autograder.author.verification.fork_server" in Path(f"/proc/{child}/cmdline").read_text():
                    servers.add(int(child))
    return servers


@pytest.fixture
def servers() -> Servers:
    """Return a function that lists the fork servers started by the test, without those of other tests."""
    before = _fork_servers()
    return lambda: sorted(_fork_servers() - before)


def test_a_shared_sandbox_gives_the_same_results_as_one_for_each_submission(
    reference: Path, incomplete_submission: Path, servers: Servers, tmp_path: Path
) -> None:
    with WorkerPool(Isolation.BUBBLEWRAP, 1) as workers:
        shared = [
            _grade(path, tmp_path / "shared", workers, SOME_CHECKS)
            for path in (reference, incomplete_submission, reference)
        ]
        assert len(servers()) == 1
    assert servers() == []
    separate = [
        _grade(path, tmp_path / "separate", run_in_own_sandbox, SOME_CHECKS)
        for path in (reference, incomplete_submission)
    ]
    assert [_verdicts(result) for result in shared] == [_verdicts(separate[number]) for number in (0, 1, 0)]
    for shared_result, separate_result in zip(shared, separate, strict=False):
        assert (shared_result.suite_version, shared_result.files_digest) == (
            separate_result.suite_version,
            separate_result.files_digest,
        )
    assert {check.outcome for check in shared[0].checks if check.id in SOME_CHECKS.only} == {Outcome.PASSED}
    assert shared[1].diagnosis.kind is Kind.HALF_WRITTEN_PACKAGE


def _zombies(pid: int) -> list[int]:
    """Return the descendants that have ended without the verification's fork server waiting for them."""
    zombies = []
    for child in procfs.children(pid):
        with contextlib.suppress(OSError):
            is_zombie = Path(f"/proc/{child}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
            by_server = "autograder.author.verification" in Path(f"/proc/{pid}/cmdline").read_text()
            zombies += [child] if is_zombie and by_server else _zombies(child)
    return zombies


def test_a_worker_waits_for_the_processes_that_earlier_submissions_left(
    reference: Path, incomplete_submission: Path, servers: Servers, tmp_path: Path
) -> None:
    with WorkerPool(Isolation.BUBBLEWRAP, 1) as workers:
        _grade(reference, tmp_path / "reference", workers, SOME_CHECKS)
        (server,) = servers()
        zombies = _zombies(server)
        _grade(incomplete_submission, tmp_path / "incomplete", workers)
        assert set(zombies).isdisjoint(_zombies(server))


def test_a_worker_can_be_used_after_the_thread_that_used_it_first_has_ended(
    incomplete_submission: Path, servers: Servers, tmp_path: Path
) -> None:
    servers_used = []
    with WorkerPool(Isolation.BUBBLEWRAP, 1) as workers:
        for name in ("one", "two"):
            with ThreadPoolExecutor(1) as thread:
                result = thread.submit(_grade, incomplete_submission, tmp_path / name, workers).result()
            assert result.diagnosis.kind is Kind.HALF_WRITTEN_PACKAGE
            servers_used.append(servers())
    assert len(servers_used[0]) == 1
    assert servers_used[0] == servers_used[1]


def test_a_failed_grading_reports_the_reason_and_the_next_one_gets_a_new_sandbox(
    reference: Path, incomplete_submission: Path, servers: Servers, tmp_path: Path
) -> None:
    with WorkerPool(Isolation.BUBBLEWRAP, 1) as workers:
        _grade(incomplete_submission, tmp_path / "before", workers)
        before = servers()
        failed = _grade(reference, tmp_path / "failed", workers, Options(only=("no_such_check",)))
        graded = _grade(incomplete_submission, tmp_path / "graded", workers)
        assert len(servers()) == 1
        assert servers() != before
    assert failed.status is Status.NOT_GRADED
    assert "no record of no_such_check" in (tmp_path / "failed" / LOG).read_text()
    assert graded.diagnosis.kind is Kind.HALF_WRITTEN_PACKAGE


def test_a_fork_server_that_ends_is_replaced_and_leaves_nothing(
    incomplete_submission: Path, servers: Servers, entered_tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(entered_tmp_path))
    with WorkerPool(Isolation.PROCESS, 1) as workers:
        assert (
            _grade(incomplete_submission, entered_tmp_path / "one", workers, isolation=Isolation.PROCESS).status
            is Status.GRADED
        )
        (sandbox,) = entered_tmp_path.glob("autograder-worker-*")
        assert list(sandbox.iterdir()) == []
        (server,) = servers()
        os.kill(server, signal.SIGKILL)
        assert (
            _grade(incomplete_submission, entered_tmp_path / "two", workers, isolation=Isolation.PROCESS).status
            is Status.GRADED
        )
        assert servers() not in ([], [server])
    assert list(entered_tmp_path.glob("autograder-worker-*")) == []
