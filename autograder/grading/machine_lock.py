"""A readers-writer lock on the machine: many gradings share it, or one has it to itself."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager


class MachineLock:
    """Who wants the machine exclusively waits until all others are done; whoever comes meanwhile waits as well."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._sharing, self._waiting, self._exclusive = 0, 0, False

    @contextmanager
    def shared(self) -> Iterator[None]:
        """Use the machine while others may use it."""
        with self._changed:
            self._changed.wait_for(lambda: not (self._exclusive or self._waiting))
            self._sharing += 1
        try:
            yield
        finally:
            with self._changed:
                self._sharing -= 1
                self._changed.notify_all()

    @contextmanager
    def exclusive(self) -> Iterator[None]:
        """Use the machine while no other does."""
        with self._changed:
            self._waiting += 1
            try:
                self._changed.wait_for(lambda: not (self._exclusive or self._sharing))
                self._exclusive = True
            finally:
                self._waiting -= 1
                self._changed.notify_all()
        try:
            yield
        finally:
            with self._changed:
                self._exclusive = False
                self._changed.notify_all()
