"""Runs `ros2` in a sandbox, as the child of a process that outlives it and adopts the processes that it leaves running.

    python launch_runner.py DESCRIPTOR ARGUMENTS-OF-ROS2...

When `ros2` has ended, its exit status is written to DESCRIPTOR, and this process waits to be killed. `ros2` is its
first child. If DESCRIPTOR is a dash, this process becomes `ros2`.
"""

from __future__ import annotations

import ctypes
import os
import runpy
import signal
import sys
from typing import NoReturn

PR_SET_CHILD_SUBREAPER = 36


def report_exit(child: int, descriptor: int) -> NoReturn:
    """Write the exit status of a child to a descriptor once it has ended, and wait to be killed."""
    _, status = os.waitpid(child, 0)
    os.write(descriptor, f"{os.waitstatus_to_exitcode(status)}\n".encode())
    while True:
        signal.pause()


def main() -> None:
    """Run `ros2` in a child, and report its exit status, or run it in this process."""
    descriptor = sys.argv.pop(1)
    if descriptor != "-":
        ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
        child = os.fork()
        if child:
            report_exit(child, int(descriptor))
        os.close(int(descriptor))
    if fork_children := globals().get("fork_children"):  # set by the fork server
        fork_children()
    del sys.path[0]  # the launch must not import from this file's folder
    runpy.run_module("autograder.ros.ros2", run_name="__main__", alter_sys=True)


if __name__ == "__main__":
    main()
