"""Measures how long a busy machine kept programs in real time from running.

Only the kernel can distinguish a slow program from one that did not get a processor. A stall of the whole machine also
stalls the grader, and shows in the grader's own clock. What the submission's own processes used is not the machine's.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager

from autograder.run.sandbox.starvation import look, starved, used


@contextmanager
def watch(pids: Iterable[int], seconds: float, report: Callable[[float], None]) -> Iterator[None]:
    """Measure how long processes could not run during this block, which takes `seconds` on an idle machine.

    `report` gets the longest time in s for which others kept one of them, or this one, from running.
    """
    pids = tuple(pids)
    before, began = look(pids), time.monotonic()
    yield
    late = time.monotonic() - began - max(0.0, seconds)
    after = look(pids)
    report(max(0.0, late - used(before, after), starved(before, after)))
