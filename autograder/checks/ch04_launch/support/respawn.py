"""Whether a launch starts a program again that was killed."""

from __future__ import annotations

from autograder.checks import expect
from autograder.harness.launch import LaunchHarness

RESPAWN_SECONDS = 10.0  # real time; half a second is asked for


def expect_respawn(harness: LaunchHarness) -> None:
    """Kill the reporter and expect another one.

    Raises:
        StudentError: it stays away, or the launch ends.
    """
    before = _reporters(harness)
    harness.kill("reporter")
    back = harness.wait_for(lambda: bool(_reporters(harness) - before), RESPAWN_SECONDS)
    expect(back, "The reporter was killed, and stayed away.")
    expect(harness.status is None, "The reporter was killed, and the launch ended with it.")


def _reporters(harness: LaunchHarness) -> set[int]:
    return {program.pid for program in harness.programs() if program.name == "reporter"}
