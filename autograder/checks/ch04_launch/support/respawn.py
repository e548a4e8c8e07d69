"""Tests whether a launch restarts a program each time it is killed."""

from __future__ import annotations

import time

from autograder.checking import LaunchHarness, RunningProgram, expect

RESPAWN_SECONDS = 10.0  # s of real time to wait for a new reporter; the machine may be busy
DELAY = 0.5  # s from the end of a reporter to the start of the next one
LATE = 0.95  # s: a delay that is too long; a busy machine hardly ever delays all three trials this much
COUNT_TEXTS = ("once", "twice", "three times")


def expect_respawn(harness: LaunchHarness) -> None:
    """Kill the reporter three times; fail the check unless each time, a new one starts half a second later.

    Raises:
        CheckFailed: no new reporter starts, one starts too early, all start too late, or the launch ends.
    """
    seconds = [_respawn(harness, count_text) for count_text in COUNT_TEXTS]
    template = f"The reporter was started again {{:.2f}} s after it had been killed, instead of after {DELAY:g} s."
    expect(min(seconds) >= DELAY - harness.start_resolution, template.format(min(seconds)), fraction=0.5)
    expect(min(seconds) < LATE, template.format(min(seconds)), fraction=0.5)


def _respawn(harness: LaunchHarness, count_text: str) -> float:
    """Kill the reporter; return the seconds until the kernel started the next one."""
    before, start_times = _reporters(harness), list[float]()
    kill_time = time.clock_gettime(time.CLOCK_BOOTTIME)
    harness.kill("reporter")

    def has_restarted() -> bool:
        start_times.extend(filter(None, (program.start_seconds for program in _reporters(harness) - before)))
        return bool(start_times)

    message = f"After the reporter was killed {count_text}, it was not started again."
    expect(harness.wait_for(has_restarted, RESPAWN_SECONDS), message)
    expect(harness.status is None, "After the reporter was killed, the launch ended.")
    return min(start_times) - kill_time


def _reporters(harness: LaunchHarness) -> set[RunningProgram]:
    return {program for program in harness.programs() if program.name == "reporter"}
