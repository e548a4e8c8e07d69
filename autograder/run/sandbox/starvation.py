"""Measures how long processes outside a submission kept its programs from running.

The kernel reports how long a thread has waited for a processor, but not which process used the processor meanwhile. If
that process belongs to the submission, its processor time grows by as much as the thread waits. So other processes
caused the waiting time that exceeds the submission's processor time.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from autograder.run.sandbox import procfs
from autograder.run.sandbox.procfs import CpuTime, ThreadTime

_MAX_THREADS = 10_000  # how many threads are counted, far more than a program may have


@dataclass(frozen=True)
class CpuUse:
    """The processor times of some programs' threads, and of all processes of this grading, at one instant."""

    threads: Mapping[int, ThreadTime]
    processes: Mapping[int, CpuTime]


def measure_use(pids: Iterable[int]) -> CpuUse:
    """Measure the threads of programs, and this process with all its descendants."""
    pids = tuple(pids)
    return CpuUse(
        procfs.thread_times(pids), procfs.cpu_times(procfs.measure(os.getpid(), *pids, max_threads=_MAX_THREADS).pids)
    )


def used_seconds(before: CpuUse, after: CpuUse) -> float:
    """Return the processor time, in s, that this grading's processes used between two measurements.

    The kernel adds the time of a process that has ended to that of its parent. If the parent does not wait for its
    children, only their time until the first measurement is known.
    """
    old, new = before.processes, after.processes
    running = sum(time.own - old.get(pid, CpuTime()).own for pid, time in new.items())
    ended = sum(time.reaped - old.get(pid, CpuTime()).reaped for pid, time in new.items())
    ended -= sum(time.own + time.reaped for pid, time in old.items() if pid not in new)
    return max(0.0, running) + max(0.0, ended)


def starved_seconds(before: CpuUse, after: CpuUse) -> float:
    """Return the longest time, in s, for which other processes kept a thread of the programs from running."""
    total = used_seconds(before, after)

    def starved_by_others(thread: int, current: ThreadTime) -> float:
        previous = before.threads.get(thread, ThreadTime())
        return current.waited - previous.waited - max(0.0, total - (current.ran - previous.ran))

    return max((starved_by_others(thread, current) for thread, current in after.threads.items()), default=0.0)
