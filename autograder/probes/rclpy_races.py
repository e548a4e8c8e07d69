"""Recognises errors that rclpy sometimes raises when a signal ends a program, even a correct one."""

from __future__ import annotations

import signal

_CRASH_SIGNALS = (signal.SIGSEGV, signal.SIGABRT)  # signals of a crash in the C++ code below rclpy
_SHELL_OFFSET = 128  # a shell and bubblewrap add it to the number of a signal


def crashed(status: int | None) -> bool:
    """Return whether an exit status comes from a crash of native code, which Python code alone cannot cause.

    On a busy machine, a node sometimes crashes if a thread still spins while the main thread shuts the context down.
    """
    return status is not None and any(status in (-number, _SHELL_OFFSET + number) for number in _CRASH_SIGNALS)


def lost_a_race(output: str) -> bool:
    """Return whether a program's output ends with the traceback of an error that rclpy raises by chance.

    Each error results from a race of a few microseconds with rclpy's signal thread, which shuts the context down after
    other code has found it valid: an executor that builds its wait set, or `Context.try_shutdown`. On a busy machine,
    the latter loses in one of 500 cases. Calling `rclpy.shutdown` after the signal is not a race: it fails every time.
    """
    lines = output.splitlines()
    frames = [line for line in lines if line.startswith("  File ")]
    if not frames:
        return False
    frame, error = frames[-1], next(line for line in reversed(lines) if line.strip())
    in_executor = "rclpy/executors.py" in frame and "context" in error
    in_try_shutdown = frame.endswith("in try_shutdown") and "rclpy/context.py" in frame and "already called" in error
    return in_executor or in_try_shutdown
