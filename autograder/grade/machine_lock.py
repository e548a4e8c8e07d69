"""A readers-writer lock: many gradings share the machine, or a single one uses it alone."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager


class MachineLock:
    """A caller of `exclusive` waits until all earlier callers are done, and later callers wait until it is done."""

    def __init__(self) -> None:
        self._turn = threading.Lock()  # held by a thread that waits for exclusive use, so that later threads wait
        self._changed = threading.Condition()
        self._sharing_count = 0

    @contextmanager
    def shared(self) -> Iterator[None]:
        """Use the machine together with others."""
        with self._turn, self._changed:
            self._sharing_count += 1
        try:
            yield
        finally:
            with self._changed:
                self._sharing_count -= 1
                self._changed.notify()

    @contextmanager
    def exclusive(self) -> Iterator[None]:
        """Use the machine alone."""
        with self._turn, self._changed:
            self._changed.wait_for(lambda: self._sharing_count == 0)
            yield
