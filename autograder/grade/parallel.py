"""Calls a function with many items, several at once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from typing import TypeVar

T = TypeVar("T")
R = TypeVar("R")


def map_parallel(do: Callable[[T], R], items: Sequence[T], *, jobs: int, on_done: Callable[[R], None]) -> tuple[R, ...]:
    """Call `do` with each item, `jobs` at once; return the results in the order of the items.

    `on_done` gets each result as it comes. The first exception, or Ctrl-C, comes out once what has begun is done, and
    nothing more is begun.
    """
    with ThreadPoolExecutor(jobs) as pool:
        running = [pool.submit(do, item) for item in items]
        try:
            for future in as_completed(running):
                on_done(future.result())
        finally:
            pool.shutdown(wait=False, cancel_futures=True)
        return tuple(future.result() for future in running)
