"""The line from a worker to the process that started it: its only way out of its sandbox."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing.connection import Connection

_lock = threading.Lock()
_line: Connection | None = None


def take(line: Connection) -> None:
    """Use a connection as this process's line."""
    global _line
    _line = line


@contextmanager
def held() -> Iterator[Connection | None]:
    """Have the line for one question and its answer; None in a process that has none."""
    with _lock:
        yield _line
