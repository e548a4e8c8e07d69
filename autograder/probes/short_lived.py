"""A program of a launch that ends by itself: which programs ran beside it, and whether it hangs at its end."""

from __future__ import annotations

import time

from autograder.harness.launch import LaunchHarness
from autograder.probes.launch_probe import QUIET_SECONDS, START_SECONDS, ended

UNSEEN_SECONDS = 5.0  # real time, once others run, until a program that was not seen will not come


def run_together(harness: LaunchHarness, first: str, second: str) -> bool:
    """Watch a launch until the program `first`, which ends by itself, is gone; return whether `second` ran beside it.

    The output of the launch is ignored: a launch file can print the same lines.
    """
    seen = together = False
    since = time.monotonic()

    def gone() -> bool:
        nonlocal seen, together, since
        running = {program.name for program in harness.programs()}
        seen, together = seen or first in running, together or {first, second} <= running
        if not running:
            since = time.monotonic()
        return first not in running and (seen or time.monotonic() - since > UNSEEN_SECONDS)

    harness.wait_for(gone, START_SECONDS)
    return together


def hangs(harness: LaunchHarness, name: str) -> bool:
    """Wait for a program that ends by itself; return whether it hangs, so that a second launch has to decide.

    It hangs if the launch still runs after `START_SECONDS`, and neither its end nor others without it were seen. Where
    five programs came and went together, one in 600 did so at its end: `expect_clean_stop` says why.
    """
    since = time.monotonic()

    def over() -> bool:
        nonlocal since
        running = {program.name for program in harness.programs()}
        if name in running or not running:
            since = time.monotonic()
        return name in ended(harness.output) or time.monotonic() - since > QUIET_SECONDS

    return not harness.wait_for(over, START_SECONDS) and harness.status is None
