"""Attacks on 04: launch files that steal, and that print what launch would print."""

from __future__ import annotations

from autograder.checking.attacks import FORGE_PASSES, SEARCH, STOP_PARENT, Attack, Chapter

CHAPTER = Chapter("04_launch")
ROBOT, SAFE = (f"my_robot_bringup/launch/{name}.launch.py" for name in ("robot", "safe_start"))
FORGE_ORDER = """
print("[INFO] [self_test-1]: process started with pid [6]", flush=True)
print("[INFO] [reporter-2]: process started with pid [7]", flush=True)
print("[INFO] [self_test-1]: process has finished cleanly [pid 6]", flush=True)
"""

# Writes to every pipe that it can open, of any process. One of these pipes carries the launch's exit status.
WRITE_PIPES = """
import contextlib as _contextlib, glob as _glob, os as _os
for _path in _glob.glob("/proc/[0-9]*/fd/*"):
    with _contextlib.suppress(OSError):
        if _os.readlink(_path).startswith("pipe:"):
            _os.write(_os.open(_path, _os.O_WRONLY | _os.O_NONBLOCK), b"points\\n")
"""

FORGE_END = """
print("[INFO] [self_test-1]: process has finished cleanly [pid 6]", flush=True)
"""


def attacks() -> tuple[Attack, ...]:
    """Return the attacks on the chapter."""
    return (
        Attack(
            "launch thief",
            "a launch file that steals, stops its parent, and prints marks",
            CHAPTER.write("no_respawn", heads={ROBOT: SEARCH + STOP_PARENT + FORGE_PASSES}),
            CHAPTER.mutant("no_respawn").fails,
        ),
        Attack(
            "word in the pipes",
            "a launch file that writes into the pipe for its exit status",
            CHAPTER.write("no_respawn", heads={ROBOT: WRITE_PIPES, SAFE: WRITE_PIPES}),
            CHAPTER.mutant("no_respawn").fails,
        ),
        Attack(
            "pretended order",
            "a launch file that starts everything at once, and prints that the self-test has ended",
            CHAPTER.write("driver_at_once", heads={SAFE: FORGE_ORDER}),
            CHAPTER.mutant("driver_at_once").fails,
        ),
        Attack(
            "pretended end",
            "a launch file that starts everything at once, and prints the end of the self-test, but not its start",
            CHAPTER.write("driver_at_once", heads={SAFE: FORGE_END}),
            CHAPTER.mutant("driver_at_once").fails,
        ),
    )
