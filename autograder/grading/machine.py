"""The machine, shared by gradings: many beside each other, or one alone."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager


class Machine:
    """Who needs the machine alone waits until the others are done; who comes meanwhile waits, too."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._beside, self._waiting, self._alone = 0, 0, False

    @contextmanager
    def beside(self) -> Iterator[None]:
        """Use the machine beside others."""
        with self._changed:
            self._changed.wait_for(lambda: not (self._alone or self._waiting))
            self._beside += 1
        try:
            yield
        finally:
            with self._changed:
                self._beside -= 1
                self._changed.notify_all()

    @contextmanager
    def alone(self) -> Iterator[None]:
        """Use the machine while none of the others does."""
        with self._changed:
            self._waiting += 1
            try:
                self._changed.wait_for(lambda: not (self._alone or self._beside))
                self._alone = True
            finally:
                self._waiting -= 1
                self._changed.notify_all()
        try:
            yield
        finally:
            with self._changed:
                self._alone = False
                self._changed.notify_all()
