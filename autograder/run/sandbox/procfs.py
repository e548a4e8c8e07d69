"""Reads the kernel's data about processes from /proc; see proc(5)."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass

_PAGE = os.sysconf("SC_PAGE_SIZE")
_TICKS_PER_SECOND = os.sysconf("SC_CLK_TCK")
TICK = 1.0 / _TICKS_PER_SECOND  # s; the resolution of the kernel's times of processes


@dataclass(frozen=True)
class Tree:
    """The current resource use of a process and its descendants."""

    pids: tuple[int, ...]
    threads: int
    memory: int
    largest: int  # memory of the largest process


def measure(*roots: int, max_threads: int = sys.maxsize) -> Tree:
    """Measure `roots` and their descendants: process ids, threads, resident bytes.

    Processes that end meanwhile are left out. The measurement stops after `max_threads` threads, because a fork bomb
    grows faster than its threads can be counted.
    """
    pids: list[int] = []
    threads = memory = largest = 0
    pending = list(roots)
    while pending and threads <= max_threads:
        pid = pending.pop()
        try:
            tasks = os.listdir(f"/proc/{pid}/task")
            resident = int(_read(f"/proc/{pid}/statm").split()[1]) * _PAGE
        except (OSError, IndexError, ValueError):
            continue
        pids.append(pid)
        threads += len(tasks)
        memory += resident
        largest = max(largest, resident)
        for task in tasks:
            pending += _started_by(pid, task)
    return Tree(tuple(pids), threads, memory, largest)


def start_seconds(pid: int) -> float | None:
    """Return when a process started, in s since boot, rounded down to a `TICK`; None if it has ended."""
    try:
        return int(_stat(pid)[19]) / _TICKS_PER_SECOND  # starttime
    except OSError:
        return None


@dataclass(frozen=True)
class CpuTime:
    """The processor time, in s, of a process, and of those of its ended children for which it has waited."""

    own: float = 0.0
    reaped: float = 0.0


def cpu_times(pids: Iterable[int]) -> dict[int, CpuTime]:
    """Return the processor times by process, without processes that end meanwhile."""
    times = {}
    for pid in pids:
        with suppress(OSError):
            user, system, user_reaped, system_reaped = map(int, _stat(pid)[11:15])  # utime, stime, cutime and cstime
            times[pid] = CpuTime((user + system) * TICK, (user_reaped + system_reaped) * TICK)
    return times


def cpu_seconds(pids: Iterable[int]) -> float:
    """Return the processor time that processes have used so far, without processes that end meanwhile."""
    return sum(time.own for time in cpu_times(pids).values())


@dataclass(frozen=True)
class ThreadTime:
    """How many seconds a thread has run, and has waited for a processor."""

    ran: float = 0.0
    waited: float = 0.0


def thread_times(pids: Iterable[int]) -> dict[int, ThreadTime]:
    """Return the times by thread, without threads that end meanwhile.

    See schedstat in the kernel's Documentation/scheduler/sched-stats.rst.
    """
    times = {}
    for pid in pids:
        with suppress(OSError):
            for task in os.listdir(f"/proc/{pid}/task"):
                with suppress(OSError, ValueError):
                    ran, waited, _ = _read(f"/proc/{pid}/task/{task}/schedstat").split()
                    times[int(task)] = ThreadTime(int(ran) / 1e9, int(waited) / 1e9)
    return times


def parent(pid: int) -> int | None:
    """Return the process id of a process's parent, or None if the process has ended."""
    try:
        return int(_stat(pid)[1])  # ppid
    except OSError:
        return None


def children(pid: int) -> list[int]:
    """Return the children that a process's first thread has started."""
    return _started_by(pid, pid)


def name(pid: int) -> str:
    """Return at most 15 characters of the name of a process's program, or an empty string if the process has ended."""
    try:
        return _read(f"/proc/{pid}/comm").decode(errors="replace").strip()
    except OSError:
        return ""


def _started_by(pid: int, task: int | str) -> list[int]:
    """Return the processes that a thread of a process has started, or nothing if the thread has ended."""
    try:
        return list(map(int, _read(f"/proc/{pid}/task/{task}/children").split()))
    except OSError:
        return []


def _stat(pid: int) -> list[bytes]:
    """Return the fields after the name in a process's `stat` file, beginning with the third of proc_pid_stat(5)."""
    return _read(f"/proc/{pid}/stat").rpartition(b")")[2].split()


def _read(path: str) -> bytes:
    """Read a small file of /proc. This happens often, and a `Path` would take three times as long."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        return os.read(descriptor, 65536)
    finally:
        os.close(descriptor)
