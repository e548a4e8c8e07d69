"""`ros2 topic hz` and `ros2 topic bw`: statistics over a sliding window, printed once a second."""

from __future__ import annotations

import argparse
import math
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.qos import qos_profile_sensor_data

from autograder.ros.ros2 import graph
from autograder.ros.ros2.parsing import ExitCode, positive_int
from autograder.ros.ros2.session import add_session_arguments, open_session
from autograder.ros.ros2.topic_echo import message_filter

HZ_WINDOW = 10000
BW_WINDOW = 100


@dataclass(frozen=True)
class Rate:
    """How often messages came; times in seconds, the rate in hertz."""

    rate: float
    shortest: float
    longest: float
    deviation: float
    window: int

    @classmethod
    def of(cls, arrivals: Iterable[int]) -> Rate | None:
        """Measure the times of arrival, in nanoseconds; `None` for fewer than two."""
        gaps = [(later - earlier) * 1e-9 for earlier, later in pairwise(arrivals)]
        if not gaps:
            return None
        mean = sum(gaps) / len(gaps)
        deviation = math.sqrt(sum((gap - mean) ** 2 for gap in gaps) / len(gaps))
        return cls(1 / mean if mean > 0 else 0.0, min(gaps), max(gaps), deviation, len(gaps))

    def __str__(self) -> str:
        return (
            f"average rate: {self.rate:.3f}\n\tmin: {self.shortest:.3f}s max: {self.longest:.3f}s "
            f"std dev: {self.deviation:.5f}s window: {self.window}"
        )


@dataclass(frozen=True)
class Bandwidth:
    """How much data came: bytes a second, and the sizes of single messages in bytes."""

    bytes_per_second: float
    mean: float
    smallest: int
    largest: int
    count: int

    @classmethod
    def of(cls, arrivals: Iterable[tuple[int, int]], now: int) -> Bandwidth | None:
        """Measure pairs of time of arrival (nanoseconds) and size (bytes); `None` for fewer than two."""
        pairs = list(arrivals)
        if len(pairs) < 2 or now <= pairs[0][0]:
            return None
        sizes = [size for _, size in pairs]
        total = sum(sizes)
        return cls(total / ((now - pairs[0][0]) * 1e-9), total / len(sizes), min(sizes), max(sizes), len(sizes))

    def __str__(self) -> str:
        shown: Callable[[float], str]
        if self.bytes_per_second < 1000:
            shown = lambda size: f"{int(size)} B"  # noqa: E731
        elif self.bytes_per_second < 1_000_000:
            shown = lambda size: f"{size / 1000:.2f} KB"  # noqa: E731
        else:
            shown = lambda size: f"{size / 1_000_000:.2f} MB"  # noqa: E731
        return (
            f"{shown(self.bytes_per_second)}/s from {self.count} messages\n\tMessage size mean: {shown(self.mean)} "
            f"min: {shown(self.smallest)} max: {shown(self.largest)}"
        )


def hz_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of `ros2 topic hz`."""
    parser.add_argument("topic_name", help="Name of the ROS topic to listen to (e.g. '/chatter')")
    _window_argument(parser, HZ_WINDOW)
    parser.add_argument(
        "--filter",
        dest="filter_expr",
        metavar="EXPR",
        help="only measure messages matching the specified Python expression",
    )
    parser.add_argument(
        "--wall-time",
        action="store_true",
        help="calculate the rate using wall time, which can be helpful when no clock is published during simulation",
    )
    add_session_arguments(parser)


def hz(args: argparse.Namespace) -> ExitCode:
    """Print the rate of a topic's messages once a second, until interrupted."""
    accept = message_filter(args.filter_expr)
    arrivals: deque[int] = deque(maxlen=args.window + 1)

    def start(clock: Clock) -> tuple[Callable[[Any], None], Callable[[], object]]:
        def on_message(message: Any) -> None:
            if not accept(message):
                return
            now = clock.now().nanoseconds
            if arrivals and now < arrivals[-1]:
                print("time has reset, resetting counters")
                arrivals.clear()
            arrivals.append(now)
            fresh.append(now)

        fresh: list[int] = []

        def report() -> object:
            if not fresh:
                return None
            fresh.clear()
            return Rate.of(arrivals)

        return on_message, report

    return _measure(args, args.topic_name, start, raw=args.filter_expr is None)


def bw_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of `ros2 topic bw`."""
    parser.add_argument("topic_name", help="Topic name to monitor for bandwidth utilization")
    _window_argument(parser, BW_WINDOW)
    add_session_arguments(parser)


def bw(args: argparse.Namespace) -> ExitCode:
    """Print the bandwidth of a topic once a second, until interrupted."""
    arrivals: deque[tuple[int, int]] = deque(maxlen=args.window)

    def start(clock: Clock) -> tuple[Callable[[Any], None], Callable[[], object]]:
        print(f"Subscribed to [{args.topic_name}]")
        return (
            lambda data: arrivals.append((clock.now().nanoseconds, len(data))),
            lambda: Bandwidth.of(arrivals, clock.now().nanoseconds),
        )

    args.wall_time = True
    return _measure(args, args.topic_name, start, raw=True)


def _measure(
    args: argparse.Namespace,
    topic: str,
    start: Callable[[Clock], tuple[Callable[[Any], None], Callable[[], object]]],
    *,
    raw: bool,
) -> ExitCode:
    """Subscribe once the topic is there, and print what the measurement reports once a second."""
    with open_session(args) as session:
        message_class = graph.message_class_of(session, topic, blocking=True)
        clock = Clock(clock_type=ClockType.STEADY_TIME) if args.wall_time else session.node.get_clock()
        on_message, report = start(clock)

        def show() -> None:
            found = report()
            if found is not None:
                print(found)

        session.node.create_subscription(message_class, topic, on_message, qos_profile_sensor_data, raw=raw)
        # Wall time even with --use-sim-time: a clock that stands still must not keep the user from seeing it.
        session.node.create_timer(1.0, show, clock=Clock(clock_type=ClockType.STEADY_TIME))
        session.spin()
    return None


def _window_argument(parser: argparse.ArgumentParser, default: int) -> None:
    parser.add_argument(
        "-w",
        "--window",
        type=positive_int,
        default=default,
        metavar="WINDOW",
        help=f"window size, in # of messages, for calculating rate (default: {default})",
    )
