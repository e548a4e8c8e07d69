"""`ros2` in a sandbox, with someone who outlives it and sees what it has left behind.

    python launch_host DESCRIPTOR WORDS-OF-ROS2...

When `ros2` has ended, its exit status is written to DESCRIPTOR, and this process waits to be killed. `ros2` is its
first child; whatever loses its parent becomes another one. Without such care, if DESCRIPTOR is a dash, this process
becomes `ros2`. Where it was forked from a zygote, the Python programs that a launch starts are forked, too.
"""

from __future__ import annotations

import ctypes
import importlib
import os
import runpy
import signal
import sys
from pathlib import Path
from typing import Any, NoReturn

PR_SET_CHILD_SUBREAPER = 36
ZYGOTE_HOST = Path(__file__).parents[2] / "sandbox" / "zygote_host"
LAUNCH_ONLY = ("autograder", "launch", "launch_ros", "standin_notice")


def hold(child: int, descriptor: int) -> NoReturn:
    """Tell the end of a child, and stay."""
    _, status = os.waitpid(child, 0)
    os.write(descriptor, f"{os.waitstatus_to_exitcode(status)}\n".encode())
    while True:
        signal.pause()


def open_nursery() -> Any:
    """Let the programs of this process be forked; in their processes, return what is to be run."""
    sys.path.insert(1, str(ZYGOTE_HOST))
    nursery = importlib.import_module("nursery")
    del sys.path[1]
    nursery.be_called(["ros2", *sys.argv[1:]])
    return nursery.open_here(forget=LAUNCH_ONLY)


def main() -> Any:
    """Hold a child, or be it; return what a program that it has started is to run."""
    descriptor, forked = sys.argv.pop(1), "rclpy" in sys.modules
    if descriptor != "-":
        ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
        child = os.fork()
        if child:
            hold(child, int(descriptor))
        os.close(int(descriptor))
    return open_nursery() if forked else None


if __name__ == "__main__":
    if program := main():
        exec(*program)
    else:
        del sys.path[0]  # this file's folder is none of the launch's business
        runpy.run_module("autograder.ros.ros2", run_name="__main__", alter_sys=True)
