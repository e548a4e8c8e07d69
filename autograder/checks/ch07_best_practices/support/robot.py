"""Harnesses for the student's two nodes, sensor_processor and robust_node."""

from __future__ import annotations

import random
import re
from collections.abc import Iterator
from itertools import islice

from hypothesis import strategies as st
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32, String

from autograder.checking import LOCKSTEP, SCAN_SECONDS, AutoHarness, Workspace
from autograder.checking.probes import parameters
from autograder.checks.ch07_best_practices.support.contract import MAX_ERRORS, PACKAGE
from autograder.checks.ch07_best_practices.support.drawn_readings import Readings

FILTERED, MEAN, STATUS = "/scan_filtered", "/mean_distance", "/status"
READING_TIMEOUT = 3.0  # s of ROS time for a reading, which should take 1 s
DELAY_SECONDS = 3.0  # s to wait in real time for the first reading and for late messages


class Processor(AutoHarness):
    """The harness of sensor_processor, to which it publishes scans."""

    def __init__(self, workspace: Workspace) -> None:
        super().__init__(
            workspace,
            PACKAGE,
            "sensor_processor",
            publishes={"/scan": LaserScan},
            subscribes={FILTERED: LaserScan, MEAN: Float32},
        )

    def send_scans(self, *scans: LaserScan, apart: float = SCAN_SECONDS) -> tuple[list[LaserScan], list[float]]:
        """Publish scans, `apart` seconds apart; return the received filtered scans and means."""
        start = self.seconds
        for scan in scans:
            self.publish("/scan", scan)
            self.run(apart)
        self.wait_for_late(lambda: len(self.messages(FILTERED, since=start)) >= len(scans))
        if self.time != LOCKSTEP:
            self.run(SCAN_SECONDS)  # the number of expected means is not known
        filtered = [received.message for received in self.messages(FILTERED, since=start)]
        return filtered, [received.message.data for received in self.messages(MEAN, since=start)]


class Robust(AutoHarness):
    """The harness of robust_node, which starts with the given parameters."""

    def __init__(self, workspace: Workspace, **values: float) -> None:
        arguments = ("--ros-args", *parameters.override_arguments(values))
        super().__init__(workspace, PACKAGE, "robust_node", subscribes={STATUS: String}, arguments=arguments)
        self._count = 0  # how many statuses were already returned

    def advance(self, seconds: int) -> list[str]:
        """Let time pass, with one reading per second; return the statuses that the node published meanwhile."""
        if self.time != LOCKSTEP:  # the node's timer did not start together with the harness
            return self.receive(seconds)
        self.run(seconds + 0.05)
        return self._new_statuses()

    def receive(self, readings: int) -> list[str]:
        """Wait for this many further statuses, whatever the node's period is; return them."""
        target = self._count + readings
        timeout = READING_TIMEOUT * readings if self.time == LOCKSTEP else readings + DELAY_SECONDS
        self.until(lambda: len(self.messages(STATUS)) >= target, timeout)
        self.run(0.05 if self.time == LOCKSTEP else 0.4)
        return self._new_statuses()

    def _new_statuses(self) -> list[str]:
        statuses = [received.message.data for received in self.messages(STATUS)[self._count :]]
        self._count += len(statuses)
        return statuses


def expected_statuses(seed: int, probability: float, count: int, max_errors: int = MAX_ERRORS) -> list[str]:
    """Return the statuses that a correct node with this seed publishes for its first `count` readings."""
    return list(islice(_status_texts(random.Random(seed), probability, max_errors), count))


def _status_texts(generator: random.Random, probability: float, max_errors: int) -> Iterator[str]:
    errors = 0
    while True:
        errors = errors + 1 if generator.random() < probability else 0
        word = "unstable" if errors > max_errors else "failed"
        yield f"{word}: {errors} in a row" if errors else "ok"


def count_logged(output: str, level: str) -> int:
    """Return how many lines of a program's output are log records of a level, with a time and a logger's name."""
    return len(re.findall(rf"\[{level}\] \[\d+\.\d+\] \[[^\]]+\]: ", output))


def scan_of(case: Readings) -> LaserScan:
    """Return the scan with these readings and limits."""
    return scan(list(case.readings), range_min=case.low, range_max=case.high)


def scan(ranges: list[float], *, range_min: float = 0.12, range_max: float = 3.5) -> LaserScan:
    """Return a scan with these ranges, spread over a full turn."""
    message = LaserScan(range_min=range_min, range_max=range_max, ranges=ranges)
    message.header.frame_id = "laser"
    message.angle_increment = 6.283185 / max(1, len(ranges))
    message.angle_max = message.angle_increment * max(0, len(ranges) - 1)
    message.scan_time = SCAN_SECONDS
    return message


@st.composite
def messages(draw: st.DrawFn) -> LaserScan:
    """Draw scans with any fields. All of their readings are distances."""
    numbers = st.integers(-6000, 6000).map(lambda number: number / 1000)
    distances = draw(st.lists(st.sampled_from((1.0, 2.5)), min_size=1, max_size=5))
    message = scan(
        distances, range_min=draw(st.sampled_from((0.0, 0.12))), range_max=draw(st.sampled_from((3.5, 50.0)))
    )
    # A name with a slash or a space is unusual, so that any change of it is detected.
    message.header.frame_id = draw(st.sampled_from(("laser", "/Laser_1 ", "")) | st.text("ab/_ ", max_size=5))
    message.header.stamp.sec = draw(st.integers(0, 2**31 - 1))
    message.header.stamp.nanosec = draw(st.integers(0, 10**9 - 1))
    message.angle_min, message.angle_max, message.angle_increment = draw(st.tuples(numbers, numbers, numbers))
    message.time_increment, message.scan_time = abs(draw(numbers)) / 100, abs(draw(numbers))
    has_intensities = draw(st.booleans())
    message.intensities = [float(draw(st.integers(0, 255))) for _ in distances if has_intensities]
    return message
