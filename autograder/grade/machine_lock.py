"""A readers-writer lock: many gradings share the machine, or one has it to itself."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager


class MachineLock:
    """A caller of `exclusive` waits until all others are done; callers that come after it wait for it."""

    def __init__(self) -> None:
        self._turn = threading.Lock()  # orders the waiting threads: one that waits for the whole machine holds it
        self._changed = threading.Condition()
        self._sharing = 0

    @contextmanager
    def shared(self) -> Iterator[None]:
        """Use the machine while others may use it."""
        with self._turn, self._changed:
            self._sharing += 1
        try:
            yield
        finally:
            with self._changed:
                self._sharing -= 1
                self._changed.notify()

    @contextmanager
    def exclusive(self) -> Iterator[None]:
        """Use the machine while no other does."""
        with self._turn, self._changed:
            self._changed.wait_for(lambda: self._sharing == 0)
            yield
