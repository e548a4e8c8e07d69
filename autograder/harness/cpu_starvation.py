"""How long a busy machine kept from running what was met in real time.

Nobody can tell a program that is late from one that the machine did not let run, but for the kernel: it counts how long
each thread was ready and waited for a processor. What stops the whole machine stops the grader, too, and is seen by its
own clock.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager

from autograder.sandbox.procfs import waited_ns

_longest = 0.0  # s, of all that this process has met in real time


def longest() -> float:
    """Return the longest time in s for which a program, or the grader, could not run within one `watch`."""
    return _longest


@contextmanager
def watch(pids: Iterable[int], seconds: float) -> Iterator[None]:
    """Note how long processes are held up in this block, which by itself takes `seconds`."""
    global _longest
    pids = tuple(pids)
    before, began = waited_ns(pids), time.monotonic()
    yield
    late = time.monotonic() - began - max(0.0, seconds)
    waited = (after - before.get(thread, 0) for thread, after in waited_ns(pids).items())
    _longest = max(_longest, late, max(waited, default=0) / 1e9)
