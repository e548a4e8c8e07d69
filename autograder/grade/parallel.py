"""Calls a function with many items, several at once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from typing import TypeVar

T = TypeVar("T")
R = TypeVar("R")


def map_parallel(do: Callable[[T], R], items: Sequence[T], *, jobs: int, on_done: Callable[[R], None]) -> tuple[R, ...]:
    """Call `do` with each item, `jobs` at once; return the results in the order of the items.

    `on_done` gets each result as soon as it is available. After an exception or Ctrl-C, no further call begins. The
    first exception is raised when the running calls have finished.
    """
    with ThreadPoolExecutor(jobs) as pool:
        running = [pool.submit(do, item) for item in items]
        try:
            for future in as_completed(running):
                on_done(future.result())
        finally:
            pool.shutdown(wait=False, cancel_futures=True)
        return tuple(future.result() for future in running)
