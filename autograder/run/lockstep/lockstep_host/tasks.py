"""Tracks the positions at which rclpy's coroutines wait.

rclpy resumes waiting coroutines again and again, without knowing what they wait for. So only a change of its position
shows that a coroutine has advanced.
"""

from __future__ import annotations

import weakref
from typing import Any


class TaskPositions:
    """The positions of tasks when they were last resumed."""

    def __init__(self) -> None:
        self._positions: dict[Any, int] = {}
        self._resumed: weakref.WeakSet[Any] = weakref.WeakSet()

    def clear(self) -> None:
        """Forget the positions, because something has happened for which tasks may wait."""
        self._positions.clear()

    def advances(self, task: Any) -> bool:
        """Return whether a task has something to do when it is resumed.

        If its position is unchanged, and nothing else has happened, it has nothing to do before the next step.
        """
        position = position_of(task)
        if task not in self._resumed or self._positions.get(task, position) != position:
            self._resumed.add(task)
            self.clear()  # other tasks may wait for this one
        elif task in self._positions:
            return False
        self._positions[task] = position
        return True


def position_of(task: Any) -> int:
    """Return a number that changes when a task's coroutine advances."""
    position, inner = -1, task._handler
    while inner is not None:
        frame = getattr(inner, "cr_frame", None)
        position = hash((position, frame.f_lasti)) if frame is not None else position
        inner = getattr(inner, "cr_await", None)
    return position


def awaited_future(task: Any) -> Any:
    """Return the future that a task's coroutine waits for, or None."""
    inner = task._handler
    while getattr(inner, "cr_await", None) is not None:
        inner = inner.cr_await
    frame = getattr(inner, "gi_frame", None)
    return None if frame is None else frame.f_locals.get("self")
