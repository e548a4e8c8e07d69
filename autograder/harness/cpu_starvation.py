"""Measures how long a busy machine kept programs in real time from running.

Only the kernel can distinguish a slow program from one that did not get a processor. A stall of the whole machine also
stalls the grader, and shows in the grader's own clock.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager

from autograder.run.sandbox.procfs import waited_ns


@contextmanager
def watch(pids: Iterable[int], seconds: float, report: Callable[[float], None]) -> Iterator[None]:
    """Measure how long processes could not run during this block, which takes `seconds` on an idle machine.

    `report` gets the longest time in s for which one of them, or this one, was ready and could not run.
    """
    pids = tuple(pids)
    before, began = waited_ns(pids), time.monotonic()
    yield
    late = time.monotonic() - began - max(0.0, seconds)
    waited = (after - before.get(thread, 0) for thread, after in waited_ns(pids).items())
    report(max(late, max(waited, default=0) / 1e9))
