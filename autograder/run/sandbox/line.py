"""The line from a worker to the process that started it: the worker's only way out of its sandbox."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing.connection import Connection

_lock = threading.Lock()
_line: Connection | None = None


def set_line(connection: Connection) -> None:
    """Use a connection as this process's line."""
    global _line
    _line = connection


@contextmanager
def exclusive_line() -> Iterator[Connection | None]:
    """Reserve the line for one request and its answer. Yield None in a process without a line."""
    with _lock:
        yield _line
