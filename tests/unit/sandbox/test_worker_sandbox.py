"""The worker sandboxes of a killed grader end with it, and the next grader removes their folders."""

from __future__ import annotations

import fcntl
import os
import select
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pytest

from autograder import course_paths
from autograder.run.sandbox import Isolation, procfs
from autograder.run.sandbox.worker_sandbox import run_in_worker_sandbox


def test_only_folders_of_worker_sandboxes_without_a_lock_are_removed(
    entered_tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(entered_tmp_path))
    abandoned, locked, new, unrelated = (
        entered_tmp_path / f"{name}"
        for name in ("autograder-worker-1", "autograder-worker-2", "autograder-worker-3", "other")
    )
    for folder in (abandoned, locked, new, unrelated):
        (folder / "ws").mkdir(parents=True)
        if folder != new:
            os.utime(folder, (0, 0))
    link = entered_tmp_path / "autograder-worker-4"
    link.symlink_to(unrelated)
    descriptor = os.open(locked, os.O_RDONLY)
    fcntl.flock(descriptor, fcntl.LOCK_EX)
    try:
        report = run_in_worker_sandbox(
            lambda scratch: [sys.executable, "-c", f"print({str(scratch)!r})"], Isolation.PROCESS
        )
    finally:
        os.close(descriptor)
    assert Path(report.output.strip()).parent == entered_tmp_path
    assert {*entered_tmp_path.iterdir()} == {locked, new, unrelated, link}
    assert (unrelated / "ws").is_dir()


def test_a_worker_imports_nothing_from_the_folder_that_the_grader_was_started_in(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in ("json", "yaml", "numpy"):
        (tmp_path / f"{module}.py").write_text(f"open({str(tmp_path / 'ran')!r}, 'w')\n")
    monkeypatch.chdir(tmp_path)
    for isolation in (Isolation.PROCESS, Isolation.BUBBLEWRAP):
        report = run_in_worker_sandbox(
            lambda scratch: [sys.executable, "-m", "autograder.grade.worker", "{}"], isolation
        )
        assert "JSON" not in report.output
        assert "TypeError" in report.output  # it got as far as reading its job
    assert not (tmp_path / "ran").exists()


ENTER = """
import sys
from autograder.run.sandbox import Isolation
from autograder.run.sandbox.worker_sandbox import run_in_worker_sandbox

print(run_in_worker_sandbox(lambda scratch: [sys.executable, "-c", "print(2)"], Isolation.BUBBLEWRAP).output)
"""


def test_python_may_be_started_by_a_path_that_leads_through_a_folder_that_the_sandbox_lacks(tmp_path: Path) -> None:
    python = f"{os.path.relpath(Path(sys.executable).parent, tmp_path)}/{Path(sys.executable).name}"
    process = subprocess.run([python, "-c", ENTER], text=True, capture_output=True, cwd=tmp_path)
    assert (process.stdout, process.stderr) == ("2\n\n", "")


GRADER = """
import sys
from autograder import course_paths
from autograder.run.sandbox import Isolation, procfs
from autograder.run.sandbox.worker_sandbox import in_worker_sandbox

with in_worker_sandbox(lambda scratch: ["sh", "-c", "echo up; exec sleep 600"], Isolation.BUBBLEWRAP) as (process, _):
    while "up" not in process.output:
        process.wait(0.05)
    print("up", flush=True)
    sys.stdin.read()
"""


def test_nothing_in_a_worker_sandbox_outlives_a_killed_grader() -> None:
    """The kernel sends the parent-death signal with the rights of the parent, here root without capabilities."""
    command = [sys.executable, "-c", GRADER]
    with subprocess.Popen(command, cwd=course_paths.ROOT, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as grader:
        assert grader.stdout is not None
        assert grader.stdout.readline() == b"up\n"
        below = {os.pidfd_open(pid): procfs.name(pid) for pid in procfs.measure(grader.pid).pids if pid != grader.pid}
        assert "sleep" in below.values()
        grader.kill()
    deadline, remaining = time.monotonic() + 30.0, dict(below)
    while remaining and time.monotonic() < deadline:
        readable, _, _ = select.select(remaining, (), (), deadline - time.monotonic())
        remaining = {descriptor: name for descriptor, name in remaining.items() if descriptor not in readable}
    for descriptor in remaining:
        signal.pidfd_send_signal(descriptor, signal.SIGKILL)
    for descriptor in below:
        os.close(descriptor)
    assert not remaining.values()
