"""Whether a launch starts a program again, as often as it is killed."""

from __future__ import annotations

import time

from autograder.checking import LaunchHarness, RunningProgram, expect

RESPAWN_SECONDS = 10.0  # real time, generous for a machine that is busy
DELAY = 0.5  # s
LATE = 0.95  # s; a machine that is busy adds to the delay, but hardly so much each time
TIMES = ("once", "twice", "three times")


def expect_respawn(harness: LaunchHarness) -> None:
    """Kill the reporter three times and expect another one each time, half a second later.

    Raises:
        CheckFailed: it stays away, comes too early, comes late each time, or the launch ends.
    """
    seconds = [_respawn(harness, times) for times in TIMES]
    again = f"The reporter was started again {{:.2f}} s after it had been killed, instead of after {DELAY:g} s."
    expect(min(seconds) >= DELAY - harness.start_resolution, again.format(min(seconds)), fraction=0.5)
    expect(min(seconds) < LATE, again.format(min(seconds)), fraction=0.5)


def _respawn(harness: LaunchHarness, times: str) -> float:
    """Kill the reporter, and return after how many seconds the kernel started the next one."""
    before, started = _reporters(harness), list[float]()
    killed = time.clock_gettime(time.CLOCK_BOOTTIME)
    harness.kill("reporter")

    def back() -> bool:
        started.extend(filter(None, (program.start_seconds for program in _reporters(harness) - before)))
        return bool(started)

    expect(harness.wait_for(back, RESPAWN_SECONDS), f"The reporter was killed {times}, and stayed away.")
    expect(harness.status is None, "The reporter was killed, and the launch ended with it.")
    return min(started) - killed


def _reporters(harness: LaunchHarness) -> set[RunningProgram]:
    return {program for program in harness.programs() if program.name == "reporter"}
