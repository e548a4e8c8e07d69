"""Runs of a robust node: the status and the log lines of each reading, and the expected statuses."""

from __future__ import annotations

import itertools
import math
import random
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

from hypothesis import strategies as st

from autograder.checking import LOCKSTEP, Workspace
from autograder.checks.ch07_best_practices.support.robot import Robust, count_logged, expected_statuses

DEAD_READINGS = 30  # readings of a dead sensor
ALMOST_ONE = math.nextafter(1.0, 0.0)  # the largest number that a generator returns
FLAKY_READINGS, REAL_FLAKY_READINGS = 60, 30  # readings of a flaky sensor, in lockstep and in real time


@dataclass(frozen=True)
class Reading:
    """One reading of the sensor: the time of its status in seconds, the status, and the log lines."""

    seconds: float
    status: str
    log: str

    @property
    def recoveries(self) -> list[str]:
        """The ends of the lines that log a recovery, such as "3 errors"."""
        return [line.split("Recovered after ")[1] for line in self.log.splitlines() if "Recovered after " in line]

    def count(self, level: str) -> int:
        """Return how many lines were logged at a level."""
        return count_logged(self.log, level)


@dataclass(frozen=True)
class SensorRun:
    """A run of robust_node with these parameters."""

    seed: int
    probability: float
    max_errors: int
    readings: tuple[Reading, ...]

    @property
    def statuses(self) -> list[str]:
        """The statuses that the node published."""
        return [reading.status for reading in self.readings]

    @cached_property
    def expected(self) -> list[str]:
        """The statuses that a correct node publishes."""
        return expected_statuses(self.seed, self.probability, max(1, len(self.readings)), self.max_errors)

    @property
    def situation(self) -> str:
        """The parameters, for a message."""
        return f"With seed {self.seed}, failure_probability {self.probability} and max_errors {self.max_errors}"

    @cached_property
    def failures(self) -> list[int]:
        """For each reading, how many in a row have failed."""
        return [int(re.sub(r"\D", "", status) or 0) for status in self.expected]

    def first_wrong(self, is_correct: Callable[[int], bool]) -> int | None:
        """Return the number of the first reading, counted from 0, that is not correct, or None."""
        return next((number for number in range(len(self.readings)) if not is_correct(number)), None)


def dead_sensor(workspace: Workspace, draw: random.Random) -> SensorRun:
    """Run a node whose readings all fail."""
    return _run(workspace, 1, 1.0, draw.randint(2, 5), DEAD_READINGS, DEAD_READINGS)


def flaky_sensor(workspace: Workspace, draw: random.Random) -> SensorRun:
    """Run a node whose readings fail in many series, some of them long enough to make it unstable."""
    seed, probability, max_errors = draw_flaky(draw)
    return _run(workspace, seed, probability, max_errors, FLAKY_READINGS, REAL_FLAKY_READINGS)


def draw_flaky(draw: random.Random) -> tuple[int, float, int]:
    """Draw seed, failure probability and max_errors of a node that soon becomes unstable twice."""
    # Probabilities in tenths, so that the run does not depend on the step of the parameter's range.
    max_errors, probability = draw.randint(1, 3), draw.choice((0.5, 0.6))
    seeds = itertools.count(draw.randint(1, 2**30))
    unstable_status = f"unstable: {max_errors + 1} in a row"
    statuses = ((seed, expected_statuses(seed, probability, REAL_FLAKY_READINGS, max_errors)) for seed in seeds)
    return next(seed for seed, texts in statuses if texts.count(unstable_status) >= 2), probability, max_errors


@st.composite
def numbers_and_probabilities(draw: st.DrawFn) -> tuple[float, float]:
    """Draw a number that a generator may return, from 0 to just below 1, and a failure probability from 0 to 1."""
    number = draw(st.sampled_from((0.0, 0.5, ALMOST_ONE)) | st.integers(1, 999).map(lambda each: each / 1000))
    near = st.sampled_from((number, math.nextafter(number, 1.0), max(0.0, math.nextafter(number, -1.0))))
    return number, draw(near | st.integers(0, 1000).map(lambda each: each / 1000))


def _run(
    workspace: Workspace, seed: int, probability: float, max_errors: int, readings: int, real_readings: int
) -> SensorRun:
    record: list[Reading] = []
    with Robust(workspace, seed=seed, failure_probability=probability, max_errors=max_errors) as harness:
        log_length = len(harness.output)
        for _ in range(readings if harness.time == LOCKSTEP else real_readings):
            statuses = harness.receive(1)
            log, log_length = harness.output[log_length:], len(harness.output)
            record.append(Reading(harness.seconds, " and ".join(statuses) or "nothing", log))
            if not statuses:
                break
    return SensorRun(seed, probability, max_errors, tuple(record))
