"""The two pipes to the grader."""

from __future__ import annotations

import json
import os
from typing import Any


class Pipes:
    """The host's side of the pipes, with a JSON object per line. When the grader closes them, the program quits."""

    def __init__(self, read_fd: int, write_fd: int) -> None:
        self._reader = os.fdopen(read_fd, "r", encoding="utf-8")
        self._writer = os.fdopen(write_fd, "w", encoding="utf-8")

    def send(self, **event: Any) -> None:
        """Send the grader an event."""
        self._writer.write(json.dumps(event) + "\n")
        self._writer.flush()

    def receive(self) -> dict[str, Any]:
        """Wait for the grader's next command."""
        line = self._reader.readline()
        return dict(json.loads(line)) if line else {"op": "quit"}
