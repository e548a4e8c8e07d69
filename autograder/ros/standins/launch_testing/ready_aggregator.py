"""A callable that calls a function after a number of calls."""

from __future__ import annotations

import threading
from collections.abc import Callable


class ReadyAggregator:
    """Calls `ready_fn` when its own `ready_fn` has been called `num_to_aggregate` times; from any thread."""

    def __init__(self, ready_fn: Callable[[], object], num_to_aggregate: int) -> None:
        self._callback = ready_fn
        self._remaining = num_to_aggregate
        self._lock = threading.Lock()

    def ready_fn(self) -> None:
        """Count one call."""
        with self._lock:
            self._remaining -= 1
            is_last = self._remaining == 0
        if is_last:
            self._callback()
