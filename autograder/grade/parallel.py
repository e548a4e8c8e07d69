"""Calls a function with each of many items, several at once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from typing import TypeVar

T = TypeVar("T")
R = TypeVar("R")


def map_parallel(
    function: Callable[[T], R], items: Sequence[T], *, jobs: int, on_done: Callable[[R], None]
) -> tuple[R, ...]:
    """Call `function` with each item, `jobs` at once; return the results in the order of the items.

    `on_done` gets each result as soon as it is available. After an exception or Ctrl-C, no further call begins. The
    first exception is raised when the running calls have finished.
    """
    with ThreadPoolExecutor(jobs) as pool:
        futures = [pool.submit(function, item) for item in items]
        try:
            for future in as_completed(futures):
                on_done(future.result())
        finally:
            pool.shutdown(wait=False, cancel_futures=True)
        return tuple(future.result() for future in futures)
