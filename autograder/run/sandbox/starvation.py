"""Measures how long processes outside a submission kept its programs from running.

The kernel reports how long a thread has waited for a processor, but not which process used the processor meanwhile. If
that process belongs to the submission, its processor time grows by as much as the thread waits. So other processes
caused the waiting time that exceeds the submission's processor time.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from autograder.run.sandbox import cgroup, procfs
from autograder.run.sandbox.procfs import CpuTime, ThreadTime

_MAX_THREADS = 10_000  # how many threads are counted, far more than a program may have


@dataclass(frozen=True)
class CpuUse:
    """The processor times of some programs' threads, and of all processes of this grading, at one instant.

    `total` is the time, in s, that a control group has counted. Without one it is None, and `processes` has the times
    of single processes.
    """

    threads: Mapping[int, ThreadTime]
    processes: Mapping[int, CpuTime]
    total: float | None = None


def measure_use(pids: Iterable[int]) -> CpuUse:
    """Measure the threads of programs, and this process with all its descendants, or the whole worker sandbox."""
    pids = tuple(pids)
    if (total := cgroup.used_seconds()) is not None:
        return CpuUse(procfs.thread_times(pids), {}, total)
    return CpuUse(
        procfs.thread_times(pids), procfs.cpu_times(procfs.measure(os.getpid(), *pids, max_threads=_MAX_THREADS).pids)
    )


def used_seconds(before: CpuUse, after: CpuUse) -> float:
    """Return the processor time, in s, that this grading's processes used between two measurements.

    Without a control group, the time of some processes that ended in between is unknown: the kernel adds it to that of
    the parent only if the parent waits for its children, and a program can choose not to. Such time seems to be used by
    others. So a program can use up its own time slowly in lockstep, and can have its submission graded once more, alone
    on the machine, but only once (`grade.pipeline.grade_submission`). The opposite error would cost honest programs
    points: threads and processes that have been waited for also end unseen.
    """
    if before.total is not None and after.total is not None:
        return after.total - before.total
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
