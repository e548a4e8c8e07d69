"""Tests whether a launched program that ends by itself ran together with another, and whether it hangs when it ends."""

from __future__ import annotations

import time

from autograder.harness.launch import LaunchHarness
from autograder.probes.launch_probe import QUIET_SECONDS, START_SECONDS, ended

START_DELAY_SECONDS = 5.0  # real time in which a program has to start after others have started


def ran_together(harness: LaunchHarness, first: str, second: str) -> bool:
    """Wait until the program `first`, which ends by itself, has ended; return whether `second` ran at the same time.

    The output of the launch is ignored: a launch file can print the same lines.
    """
    has_started = has_overlapped = False
    since = time.monotonic()

    def has_ended() -> bool:
        nonlocal has_started, has_overlapped, since
        programs = {program.name for program in harness.programs()}
        has_started, has_overlapped = has_started or first in programs, has_overlapped or {first, second} <= programs
        if not programs:
            since = time.monotonic()
        return first not in programs and (has_started or time.monotonic() - since > START_DELAY_SECONDS)

    harness.wait_for(has_ended, START_SECONDS)
    return has_overlapped


def hangs(harness: LaunchHarness, name: str) -> bool:
    """Wait for a program that ends by itself; return whether it hangs, so that a second launch has to decide.

    It hangs if the launch still runs after `START_SECONDS`, the program's end was not logged, and no other programs ran
    without it. When five programs started and ended together, one run in 600 hung at its end, for the reason that
    `expect_clean_stop` explains.
    """
    since = time.monotonic()

    def has_ended() -> bool:
        nonlocal since
        programs = {program.name for program in harness.programs()}
        if name in programs or not programs:
            since = time.monotonic()
        return name in ended(harness.output) or time.monotonic() - since > QUIET_SECONDS

    return not harness.wait_for(has_ended, START_SECONDS) and harness.status is None
