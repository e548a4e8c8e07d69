"""The student's two nodes in the harness: one is shown scans, the other is left to its failing sensor."""

from __future__ import annotations

import random
import re
from collections.abc import Iterator
from itertools import islice

from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32, String

from autograder.checking import LOCKSTEP, SCAN_SECONDS, AutoHarness, Workspace
from autograder.checking.probes import parameters
from autograder.checks.ch07_best_practices.support.contract import MAX_ERRORS, PACKAGE

FILTERED, MEAN, STATUS = "/scan_filtered", "/mean_distance", "/status"
PATIENCE = 3.0  # s of ROS time for a reading, which should take one
LATE = 3.0  # s in real time until the first reading, and for what comes late


class Processor(AutoHarness):
    """The harness of sensor_processor: it is shown one scan after the other."""

    def __init__(self, workspace: Workspace) -> None:
        super().__init__(
            workspace,
            PACKAGE,
            "sensor_processor",
            publishes={"/scan": LaserScan},
            subscribes={FILTERED: LaserScan, MEAN: Float32},
        )

    def show(self, *scans: LaserScan, apart: float = SCAN_SECONDS) -> tuple[list[LaserScan], list[float]]:
        """Show scans, so many seconds apart; return the filtered ones and the means that came."""
        began = self.seconds
        for scan in scans:
            self.publish("/scan", scan)
            self.run(apart)
        self.wait_for_late(lambda: len(self.messages(FILTERED, since=began)) >= len(scans))
        if self.time != LOCKSTEP:
            self.run(SCAN_SECONDS)  # of the means nobody knows how many are to come
        filtered = [received.message for received in self.messages(FILTERED, since=began)]
        return filtered, [received.message.data for received in self.messages(MEAN, since=began)]


class Robust(AutoHarness):
    """The harness of robust_node, started with parameters of the check's choice."""

    def __init__(self, workspace: Workspace, **values: float) -> None:
        arguments = ("--ros-args", *parameters.override_arguments(values))
        super().__init__(workspace, PACKAGE, "robust_node", subscribes={STATUS: String}, arguments=arguments)
        self._seen = 0

    def live(self, seconds: int) -> list[str]:
        """Let so many seconds pass, with a reading each; return what it said on status meanwhile."""
        if self.time != LOCKSTEP:  # its seconds did not begin with the harness's
            return self.receive(seconds)
        self.run(seconds + 0.05)
        return self._said()

    def receive(self, readings: int) -> list[str]:
        """Wait until it has said so much on status, whatever its period is; return that."""
        wanted = self._seen + readings
        longest = PATIENCE * readings if self.time == LOCKSTEP else readings + LATE
        self.until(lambda: len(self.messages(STATUS)) >= wanted, longest)
        self.run(0.05 if self.time == LOCKSTEP else 0.4)
        return self._said()

    def _said(self) -> list[str]:
        said = [received.message.data for received in self.messages(STATUS)[self._seen :]]
        self._seen += len(said)
        return said


def expected(seed: int, probability: float, count: int, max_errors: int = MAX_ERRORS) -> list[str]:
    """Return what a node with this seed says at its first `count` readings, by the contract."""
    return list(islice(_status_texts(random.Random(seed), probability, max_errors), count))


def _status_texts(generator: random.Random, probability: float, max_errors: int) -> Iterator[str]:
    errors = 0
    while True:
        errors = errors + 1 if generator.random() < probability else 0
        word = "unstable" if errors > max_errors else "failed"
        yield f"{word}: {errors} in a row" if errors else "ok"


def logged(output: str, level: str) -> int:
    """Return how many lines of a program's output were logged at a level: they name the time and the logger."""
    return len(re.findall(rf"\[{level}\] \[\d+\.\d+\] \[[^\]]+\]: ", output))


def scan(ranges: list[float], *, range_min: float = 0.12, range_max: float = 3.5) -> LaserScan:
    """Return a scan with these ranges, spread over a full turn."""
    message = LaserScan(range_min=range_min, range_max=range_max, ranges=ranges)
    message.header.frame_id = "laser"
    message.angle_increment = 6.283185 / max(1, len(ranges))
    message.angle_max = message.angle_increment * max(0, len(ranges) - 1)
    message.scan_time = SCAN_SECONDS
    return message
