"""`ros2 topic hz`: statistics over a sliding window, printed once a second."""

from __future__ import annotations

import argparse
import math
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.qos import qos_profile_sensor_data

from autograder.ros.ros2 import graph
from autograder.ros.ros2.parsing import ExitCode, positive_int
from autograder.ros.ros2.session import add_session_arguments, open_session
from autograder.ros.ros2.topic_echo import message_filter

WINDOW = 10000  # messages; how many are used for the statistics by default


@dataclass(frozen=True)
class Rate:
    """The rate of received messages in hertz, and statistics of the intervals between them in seconds."""

    rate: float
    shortest: float
    longest: float
    deviation: float
    window: int

    @classmethod
    def of(cls, arrivals: Iterable[int]) -> Rate | None:
        """Compute the rate from times of arrival in nanoseconds. With fewer than two times, return `None`."""
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


def hz_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of `ros2 topic hz`."""
    parser.add_argument("topic_name", help="Name of the ROS topic to listen to (e.g. '/chatter')")
    parser.add_argument(
        "-w",
        "--window",
        type=positive_int,
        default=WINDOW,
        metavar="WINDOW",
        help=f"window size, in # of messages, for calculating rate (default: {WINDOW})",
    )
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
    new_arrivals: list[int] = []  # the times of arrival since the last line was printed
    with open_session(args) as session:
        message_class = graph.message_class_of(session, args.topic_name, blocking=True)
        clock = Clock(clock_type=ClockType.STEADY_TIME) if args.wall_time else session.node.get_clock()

        def on_message(message: Any) -> None:
            if not accept(message):
                return
            now = clock.now().nanoseconds
            if arrivals and now < arrivals[-1]:
                print("time has reset, resetting counters")
                arrivals.clear()
            arrivals.append(now)
            new_arrivals.append(now)

        def print_rate() -> None:
            rate = Rate.of(arrivals) if new_arrivals else None
            new_arrivals.clear()
            if rate is not None:
                print(rate)

        raw = args.filter_expr is None
        session.node.create_subscription(message_class, args.topic_name, on_message, qos_profile_sensor_data, raw=raw)
        # Always use wall time, so that the rate is printed even if the simulated clock has stopped.
        session.node.create_timer(1.0, print_rate, clock=Clock(clock_type=ClockType.STEADY_TIME))
        session.spin()
    return None
