"""Tasks: where rclpy's coroutines stand.

rclpy resumes those that wait over and over, and does not say what they wait for.
"""

from __future__ import annotations

from typing import Any


def where(task: Any) -> int:
    """Return a number that changes when a task's coroutine gets on."""
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
