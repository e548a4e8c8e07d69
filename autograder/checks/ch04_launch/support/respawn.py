"""Whether a launch starts a program again that was killed."""

from __future__ import annotations

import time

from autograder.checks import expect
from autograder.harness.launch import LaunchHarness

RESPAWN_SECONDS = 10.0  # real time, generous for a machine that is busy
DELAY = 0.5  # s


def expect_respawn(harness: LaunchHarness) -> None:
    """Kill the reporter and expect another one, not before half a second has passed.

    Raises:
        CheckFailed: it stays away, comes at once, or the launch ends.
    """
    before = _reporters(harness)
    killed = time.monotonic()
    harness.kill("reporter")
    back = harness.wait_for(lambda: bool(_reporters(harness) - before), RESPAWN_SECONDS)
    expect(back, "The reporter was killed, and stayed away.")
    seconds = time.monotonic() - killed
    expect(harness.status is None, "The reporter was killed, and the launch ended with it.")
    hasty = f"The reporter was started again {seconds:.2f} s after it had been killed, instead of after {DELAY:g} s."
    expect(seconds >= DELAY, hasty, fraction=0.5)


def _reporters(harness: LaunchHarness) -> set[int]:
    return {program.pid for program in harness.programs() if program.name == "reporter"}
