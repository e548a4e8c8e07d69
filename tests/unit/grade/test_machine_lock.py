"""Gradings share the machine, and an exclusive grading has it alone."""

from __future__ import annotations

import threading
import time
from concurrent.futures import ThreadPoolExecutor

import pytest

from autograder.grade.machine_lock import MachineLock

SECONDS = 60.0  # deadline for events that must happen


def test_several_gradings_share_the_machine() -> None:
    machine, all_entered = MachineLock(), threading.Barrier(3)

    def share_machine() -> int:
        with machine.shared():
            return all_entered.wait(SECONDS)

    with ThreadPoolExecutor(3) as pool:
        assert sorted(future.result() for future in [pool.submit(share_machine) for _ in range(3)]) == [0, 1, 2]


@pytest.mark.promise("a program in real time that lost a point while the machine was busy is graded once more, alone")
def test_an_exclusive_grading_waits_for_the_others_and_later_ones_wait_for_it() -> None:
    machine, order = MachineLock(), list[str]()
    started, release = threading.Event(), threading.Event()

    def grade_beside(name: str, wait: threading.Event | None = None) -> None:
        with machine.shared():
            started.set()
            if wait is not None:
                wait.wait(SECONDS)
            order.append(name)

    def grade_alone(name: str) -> None:
        with machine.exclusive():
            order.append(f"{name} begins")
            order.append(f"{name} ends")

    with ThreadPoolExecutor(4) as pool:
        futures = [pool.submit(grade_beside, "first", release)]
        assert started.wait(SECONDS)
        futures.append(pool.submit(grade_alone, "a"))
        deadline = time.monotonic() + SECONDS
        while not machine._turn.locked():
            assert time.monotonic() < deadline
            threading.Event().wait(0.01)
        futures.append(pool.submit(grade_beside, "late"))
        release.set()
        for future in futures:
            future.result(SECONDS)
    assert order == ["first", "a begins", "a ends", "late"]


@pytest.mark.parametrize("mode", ["shared", "exclusive"])
def test_an_error_releases_the_machine(mode: str) -> None:
    machine = MachineLock()
    with pytest.raises(ValueError, match="mine"), getattr(machine, mode)():
        raise ValueError("mine")
    with machine.exclusive(), pytest.raises(ZeroDivisionError):
        _ = 1 / 0
    with machine.shared():
        pass
