"""The start time of a process is read from /proc."""

from __future__ import annotations

import subprocess
import sys
import time

from autograder.run.sandbox.procfs import TICK, start_seconds


def test_the_start_time_of_a_process_is_between_two_readings_of_the_clock() -> None:
    before = time.clock_gettime(time.CLOCK_BOOTTIME)
    with subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE) as child:
        after = time.clock_gettime(time.CLOCK_BOOTTIME)
        started = start_seconds(child.pid)
        child.communicate(b"\n")
    assert started is not None
    assert before - TICK <= started <= after
    assert start_seconds(child.pid) is None
