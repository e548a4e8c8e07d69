"""Positions of rclpy's coroutines.

rclpy resumes waiting coroutines over and over, and does not say what they wait for.
"""

from __future__ import annotations

import weakref
from typing import Any


class TaskPositions:
    """Where tasks stood when they were last resumed."""

    def __init__(self) -> None:
        self._positions: dict[Any, int] = {}
        self._resumed: weakref.WeakSet[Any] = weakref.WeakSet()

    def clear(self) -> None:
        """Forget the positions: something happened that tasks may wait for."""
        self._positions.clear()

    def advances(self, task: Any) -> bool:
        """Return whether a task has something to do when it is resumed.

        One that stands where it stood, while nothing else has happened, has nothing to do before the next step.
        """
        position = position_of(task)
        if task not in self._resumed or self._positions.get(task, position) != position:
            self._resumed.add(task)
            self.clear()  # this one advances, which may be what others wait for
        elif task in self._positions:
            return False
        self._positions[task] = position
        return True


def position_of(task: Any) -> int:
    """Return a number that changes when a task's coroutine advances."""
    place, inner = -1, task._handler
    while inner is not None:
        frame = getattr(inner, "cr_frame", None)
        place = hash((place, frame.f_lasti)) if frame is not None else place
        inner = getattr(inner, "cr_await", None)
    return place


def awaited(task: Any) -> Any:
    """Return the future that a task's coroutine waits for, or None."""
    inner = task._handler
    while getattr(inner, "cr_await", None) is not None:
        inner = inner.cr_await
    frame = getattr(inner, "gi_frame", None)
    return None if frame is None else frame.f_locals.get("self")
