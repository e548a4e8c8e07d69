"""Whether a launch starts a program again, as often as it is killed."""

from __future__ import annotations

import time

from autograder.checks import expect
from autograder.harness.launch import LaunchHarness

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
    expect(min(seconds) >= DELAY, again.format(min(seconds)), fraction=0.5)
    expect(min(seconds) < LATE, again.format(min(seconds)), fraction=0.5)


def _respawn(harness: LaunchHarness, times: str) -> float:
    before = _reporters(harness)
    killed = time.monotonic()
    harness.kill("reporter")
    back = harness.wait_for(lambda: bool(_reporters(harness) - before), RESPAWN_SECONDS)
    expect(back, f"The reporter was killed {times}, and stayed away.")
    seconds = time.monotonic() - killed
    expect(harness.status is None, "The reporter was killed, and the launch ended with it.")
    return seconds


def _reporters(harness: LaunchHarness) -> set[int]:
    return {program.pid for program in harness.programs() if program.name == "reporter"}
