"""Finds the robots that report on the topic that they share."""

from __future__ import annotations

from autograder.checking import LaunchHarness
from autograder.checks.ch04_launch.support.contract import SHARED

REPORT_SECONDS = 10.0  # s of real time for two robots to report, which they do twice a second


def reporting_robots(harness: LaunchHarness) -> set[str]:
    """Return the names of the robots that have reported on the shared topic."""
    return {str(message.data).split(" ", maxsplit=1)[0] for message in harness.messages(SHARED)}
