"""Many submissions are graded in one worker sandbox, each with the same result as in its own."""

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
from autograder.grade.pipeline import RunJob, in_own_sandbox
from autograder.grade.store import LOG
from autograder.result.model import Result, Status
from autograder.run.sandbox import Isolation, procfs
from autograder.suite import Outcome

ASSIGNMENT = "02_nodes"
PACKAGE = "my_robot_package"
Servers = Callable[[], list[int]]
SOME = Options(only=("starts", "node_name", "subscribes_scan", "publishes_cmd_vel", "threshold"))


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("reference") / "tree"
    write_reference((PACKAGE,), folder)
    return folder


@pytest.fixture(scope="module")
def half(reference: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A submission that is graded in no time: a package without setup.py."""
    folder = tmp_path_factory.mktemp("half") / "tree"
    shutil.copytree(reference, folder)
    (folder / "src" / PACKAGE / "setup.py").unlink()
    return folder


def _grade(
    path: Path, out: Path, workers: RunJob, options: Options = WHOLE_SUITE, isolation: Isolation = Isolation.BUBBLEWRAP
) -> Result:
    return grade_submission(Job(path, ASSIGNMENT, "s", 3, out, isolation, options), workers)


def _verdicts(result: Result) -> list[tuple[object, ...]]:
    return [(check.id, check.outcome, check.message, check.points) for check in result.checks]


def _running() -> set[int]:
    """Return the fork servers that run directly below this process."""
    found = set()
    for task in Path("/proc/self/task").iterdir():
        with contextlib.suppress(OSError):  # a thread, or a child, that has ended since
            for child in (task / "children").read_text().split():
                if "autograder.author.verification.fork_server" in Path(f"/proc/{child}/cmdline").read_text():
                    found.add(int(child))
    return found


@pytest.fixture
def servers() -> Servers:
    """Return a function that gives the fork servers started by the test; those of other tests' workers do not count."""
    before = _running()
    return lambda: sorted(_running() - before)


def test_a_shared_sandbox_gives_the_same_results_as_one_for_each_submission(
    reference: Path, half: Path, servers: Servers, tmp_path: Path
) -> None:
    with WorkerPool(Isolation.BUBBLEWRAP, 1) as workers:
        shared = [_grade(path, tmp_path / "shared", workers, SOME) for path in (reference, half, reference)]
        assert len(servers()) == 1
    assert servers() == []
    alone = [_grade(path, tmp_path / "alone", in_own_sandbox, SOME) for path in (reference, half)]
    assert [_verdicts(result) for result in shared] == [_verdicts(alone[number]) for number in (0, 1, 0)]
    for shared_one, own in zip(shared, alone, strict=False):
        assert (shared_one.suite_version, shared_one.files_digest) == (own.suite_version, own.files_digest)
    assert {check.outcome for check in shared[0].checks if check.id in SOME.only} == {Outcome.PASSED}
    assert shared[1].diagnosis.kind is Kind.HALF_WRITTEN_PACKAGE


def _zombies(pid: int) -> list[int]:
    """Return the ended processes below a process that the fork server of the verification did not wait for."""
    zombies = []
    for child in procfs.children(pid):
        with contextlib.suppress(OSError):
            ended = Path(f"/proc/{child}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
            by_server = "autograder.author.verification" in Path(f"/proc/{pid}/cmdline").read_text()
            zombies += [child] if ended and by_server else _zombies(child)
    return zombies


def test_a_worker_waits_for_the_processes_that_earlier_submissions_left(
    reference: Path, half: Path, servers: Servers, tmp_path: Path
) -> None:
    with WorkerPool(Isolation.BUBBLEWRAP, 1) as workers:
        _grade(reference, tmp_path / "reference", workers, SOME)
        (server,) = servers()
        left = _zombies(server)
        _grade(half, tmp_path / "half", workers)
        assert set(left).isdisjoint(_zombies(server))


def test_a_worker_can_be_used_after_the_thread_that_used_it_first_has_ended(
    half: Path, servers: Servers, tmp_path: Path
) -> None:
    seen = []
    with WorkerPool(Isolation.BUBBLEWRAP, 1) as workers:
        for name in ("one", "two"):
            with ThreadPoolExecutor(1) as thread:
                graded = thread.submit(_grade, half, tmp_path / name, workers).result()
            assert graded.diagnosis.kind is Kind.HALF_WRITTEN_PACKAGE
            seen.append(servers())
    assert len(seen[0]) == 1
    assert seen[0] == seen[1]


def test_a_failed_grading_reports_the_reason_and_does_not_change_the_next_one(
    reference: Path, half: Path, servers: Servers, tmp_path: Path
) -> None:
    with WorkerPool(Isolation.BUBBLEWRAP, 1) as workers:
        failed = _grade(reference, tmp_path / "failed", workers, Options(only=("no_such_check",)))
        graded = _grade(half, tmp_path / "graded", workers)
        assert len(servers()) == 1
    assert failed.status is Status.NOT_GRADED
    assert "no record of no_such_check" in (tmp_path / "failed" / LOG).read_text()
    assert graded.diagnosis.kind is Kind.HALF_WRITTEN_PACKAGE


def test_a_fork_server_that_ends_is_replaced_and_leaves_nothing(
    half: Path, servers: Servers, entered_tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(entered_tmp_path))
    with WorkerPool(Isolation.PROCESS, 1) as workers:
        assert _grade(half, entered_tmp_path / "one", workers, isolation=Isolation.PROCESS).status is Status.GRADED
        (sandbox,) = entered_tmp_path.glob("autograder-worker-*")
        assert list(sandbox.iterdir()) == []
        (server,) = servers()
        os.kill(server, signal.SIGKILL)
        assert _grade(half, entered_tmp_path / "two", workers, isolation=Isolation.PROCESS).status is Status.GRADED
        assert servers() not in ([], [server])
    assert list(entered_tmp_path.glob("autograder-worker-*")) == []
