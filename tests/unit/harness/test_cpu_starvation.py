"""The time for which a busy machine kept programs from running is measured."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, suppress
from types import SimpleNamespace

import pytest

from autograder.harness import cpu_starvation

SECONDS = 60.0  # for what must happen


@pytest.fixture
def waits() -> list[float]:
    """What was reported."""
    return []


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """A clock that shows what it is told, one value after the other."""
    instants: list[float] = []
    monkeypatch.setattr(cpu_starvation, "time", SimpleNamespace(monotonic=lambda: instants.pop(0)))
    return instants


@pytest.mark.parametrize(
    ("took", "seconds", "late"),
    [(0.1, 0.1, 0.0), (0.05, 0.1, 0.0), (0.7, 0.1, 0.6), (0.3, -0.5, 0.3)],
    ids=["in time", "early", "late", "nothing to wait for"],
)
def test_a_late_return_counts_as_a_stall(
    clock: list[float], waits: list[float], took: float, seconds: float, late: float
) -> None:
    clock += [5.0, 5.0 + took]
    with cpu_starvation.watch([], seconds, waits.append):
        pass
    assert waits == [pytest.approx(late)]


def test_an_ended_process_does_not_count_as_stalled(clock: list[float], waits: list[float]) -> None:
    with subprocess.Popen([sys.executable, "-c", ""]) as ended:
        pass
    clock += [0.0, 0.0]
    with cpu_starvation.watch([ended.pid], 0.0, waits.append):
        pass
    assert waits == [0.0]


def spinning(nice: int, cpu: int) -> subprocess.Popen[bytes]:
    """Start a process that keeps one processor busy."""
    code = f"import os; os.sched_setaffinity(0, [{cpu}]); os.nice({nice}); print(flush=True)\nwhile True: pass"
    return subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE)


@pytest.fixture
def crowded() -> Iterator[subprocess.Popen[bytes]]:
    """A process that shares a processor with another, which goes first."""
    cpu = min(os.sched_getaffinity(0))
    with ExitStack() as stack:
        processes = [stack.enter_context(spinning(nice, cpu)) for nice in (19, 0)]
        for process in processes:
            stack.callback(process.kill)
        for process in processes:
            assert process.stdout is not None
            process.stdout.readline()
        yield processes[0]


def test_a_process_without_a_free_processor_counts_as_stalled(
    crowded: subprocess.Popen[bytes], waits: list[float]
) -> None:
    deadline = time.monotonic() + SECONDS
    while max(waits, default=0.0) < 0.2:
        assert time.monotonic() < deadline
        with cpu_starvation.watch([crowded.pid], SECONDS, waits.append), suppress(subprocess.TimeoutExpired):
            crowded.wait(0.5)  # less than what is watched for: this is not late itself
