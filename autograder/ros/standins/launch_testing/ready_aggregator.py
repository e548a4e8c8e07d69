"""Calls a function at the n-th request."""

from __future__ import annotations

import threading
from collections.abc import Callable


class ReadyAggregator:
    """Calls `ready_fn` when its own `ready_fn` has been called `num_to_aggregate` times; from any thread."""

    def __init__(self, ready_fn: Callable[[], object], num_to_aggregate: int) -> None:
        self._call = ready_fn
        self._left = num_to_aggregate
        self._lock = threading.Lock()

    def ready_fn(self) -> None:
        """Count one call."""
        with self._lock:
            self._left -= 1
            last = self._left == 0
        if last:
            self._call()
