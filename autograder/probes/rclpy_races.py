"""Errors that rclpy raises at times when a signal ends a program, whatever that program does."""

from __future__ import annotations

import signal

_CRASHES = (signal.SIGSEGV, signal.SIGABRT)  # of the C++ code below rclpy
_SHELL = 128  # a shell and bubblewrap add it to the number of a signal


def crashed(status: int | None) -> bool:
    """Return whether an exit status is a crash of native code, which no line of Python raises by itself.

    A node whose thread still spins while the main thread shuts the context down ends so at times on a busy machine.
    """
    return status is not None and any(status in (-number, _SHELL + number) for number in _CRASHES)


def lost_a_race(output: str) -> bool:
    """Return whether a program's output ends with the traceback of an error that rclpy raises by chance.

    Each is a race of a few microseconds with rclpy's signal thread, which shuts the context down: an executor has found
    the context valid and builds its wait set, or `Context.try_shutdown` has found it valid and shuts it down itself. On
    a busy machine, the latter happens in one of 500 ends of a right program. A program that calls `rclpy.shutdown` is
    not such a case: it raises each time.
    """
    lines = output.splitlines()
    frames = [line for line in lines if line.startswith("  File ")]
    if not frames:
        return False
    frame, error = frames[-1], next(line for line in reversed(lines) if line.strip())
    in_executor = "rclpy/executors.py" in frame and "context" in error
    in_try_shutdown = frame.endswith("in try_shutdown") and "rclpy/context.py" in frame and "already called" in error
    return in_executor or in_try_shutdown
