"""Measures for how long others kept programs from running, without what the submission itself has used.

The kernel says how long a thread has waited for a processor, but not who had it. While a thread waits, its processor
runs something else. If that belongs to the submission, its processor time grows by as much as the thread waits. So the
wait that remains without that time is the machine's.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from autograder.run.sandbox import procfs
from autograder.run.sandbox.procfs import CpuTime, ThreadTime

_MOST_THREADS = 10_000  # that are counted, well above what a program may have


@dataclass(frozen=True)
class Use:
    """The times of some programs' threads, and of all processes of this grading, at one instant."""

    threads: Mapping[int, ThreadTime]
    processes: Mapping[int, CpuTime]


def look(pids: Iterable[int]) -> Use:
    """Return the times of programs, and of this process with all that it has started and has not ended."""
    pids = tuple(pids)
    return Use(procfs.thread_times(pids), procfs.cpu_times(procfs.measure(os.getpid(), *pids, most=_MOST_THREADS).pids))


def used(before: Use, after: Use) -> float:
    """Return the processor time, in s, that this grading's processes used between two looks.

    The time of a process that has ended is found with its parent. It is lost if the parent ignores the ends of its
    children, except what was seen of it.
    """
    old, new = before.processes, after.processes
    running = sum(time.own - old.get(pid, CpuTime()).own for pid, time in new.items())
    ended = sum(time.reaped - old.get(pid, CpuTime()).reaped for pid, time in new.items())
    ended -= sum(time.own + time.reaped for pid, time in old.items() if pid not in new)
    return max(0.0, running) + max(0.0, ended)


def starved(before: Use, after: Use) -> float:
    """Return the longest time, in s, for which others kept one of the programs' threads from running."""
    total = used(before, after)

    def of(thread: int, now: ThreadTime) -> float:
        then = before.threads.get(thread, ThreadTime())
        return now.waited - then.waited - max(0.0, total - (now.ran - then.ran))

    return max((of(thread, now) for thread, now in after.threads.items()), default=0.0)
