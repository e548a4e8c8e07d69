"""The time for which a busy machine kept programs from running is measured."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import SimpleNamespace

import pytest

from autograder.harness import cpu_starvation
from autograder.run.sandbox import procfs

SECONDS = 60.0  # deadline for events that must happen


@pytest.fixture
def stalls() -> list[float]:
    """The reported stalls, in seconds."""
    return []


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """A clock that returns given values, one after another."""
    instants: list[float] = []
    monkeypatch.setattr(cpu_starvation, "time", SimpleNamespace(monotonic=lambda: instants.pop(0)))
    return instants


@pytest.mark.parametrize(
    ("elapsed", "seconds", "stall"),
    [(0.1, 0.1, 0.0), (0.05, 0.1, 0.0), (0.7, 0.1, 0.6), (0.3, -0.5, 0.3)],
    ids=["in time", "early", "late", "nothing to wait for"],
)
def test_a_late_return_counts_as_a_stall(
    clock: list[float], stalls: list[float], elapsed: float, seconds: float, stall: float
) -> None:
    clock += [5.0, 5.0 + elapsed]
    with cpu_starvation.watch([], seconds, stalls.append):
        pass
    assert stalls == [pytest.approx(stall, abs=5 * procfs.TICK)]  # less what this process used meanwhile


def test_an_ended_process_does_not_count_as_stalled(clock: list[float], stalls: list[float]) -> None:
    with subprocess.Popen([sys.executable, "-c", ""]) as process:
        pass
    clock += [0.0, 0.0]
    with cpu_starvation.watch([process.pid], 0.0, stalls.append):
        pass
    assert stalls == [0.0]


@contextmanager
def busy_process(nice: int, *, adopted: bool = False) -> Iterator[int]:
    """Keep the first processor busy with a process, an orphan if `adopted`; yield its id."""
    code = f"import os; os.sched_setaffinity(0, [{min(os.sched_getaffinity(0))}]); os.nice({nice})"
    code += "; print(os.getpid(), flush=True)\nwhile True: pass"
    command = [sys.executable, "-c", code]
    if adopted:
        command = ["sh", "-c", '"$@" & exec true', "sh", *command]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        pid = int(process.stdout.readline())
        try:
            yield pid
        finally:
            os.kill(pid, signal.SIGKILL)


def test_a_process_without_a_free_processor_counts_as_stalled(stalls: list[float]) -> None:
    deadline = time.monotonic() + SECONDS
    with busy_process(19) as pid, busy_process(0, adopted=True):
        while max(stalls, default=0.0) < 0.2:
            assert time.monotonic() < deadline
            with cpu_starvation.watch([pid], SECONDS, stalls.append):
                time.sleep(0.5)  # shorter than the watch, so this process is not late itself


def test_a_processor_that_the_submission_s_own_process_has_does_not_count(stalls: list[float]) -> None:
    deadline = time.monotonic() + SECONDS
    wait_time = run_time = 0.0
    with busy_process(19) as pid, busy_process(0) as other_pid:
        wait_before = procfs.thread_times([pid])[pid].waited
        with cpu_starvation.watch([pid], SECONDS, stalls.append):
            run_before = procfs.thread_times([other_pid])[other_pid].ran
            while min(wait_time, run_time) < 0.3:
                assert time.monotonic() < deadline
                time.sleep(0.05)
                run_time = procfs.thread_times([other_pid])[other_pid].ran - run_before
                wait_time = procfs.thread_times([pid])[pid].waited - wait_before
        wait_time = procfs.thread_times([pid])[pid].waited - wait_before
    assert stalls[0] <= max(0.0, wait_time - run_time) + 10 * procfs.TICK
