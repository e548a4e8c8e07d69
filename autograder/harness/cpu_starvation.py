"""Measures how long programs in real time could not run because the machine was busy.

Only the kernel can distinguish a slow program from one that did not get a processor. A stall of the whole machine also
stalls the grader, which measures it with its own clock. Time that the submission's own processes used does not count.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager

from autograder.run.sandbox.starvation import measure_use, starved_seconds, used_seconds


@contextmanager
def watch(pids: Iterable[int], seconds: float, report: Callable[[float], None]) -> Iterator[None]:
    """Measure how long processes could not run during this block, which takes `seconds` on an idle machine.

    `report` is called with the longest time in s for which other processes kept one of the processes, or the grader,
    from running.
    """
    pids = tuple(pids)
    before, start = measure_use(pids), time.monotonic()
    yield
    delay = time.monotonic() - start - max(0.0, seconds)
    after = measure_use(pids)
    report(max(0.0, delay - used_seconds(before, after), starved_seconds(before, after)))
