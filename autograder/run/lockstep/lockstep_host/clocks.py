"""Makes every clock that the student's code reads depend only on ROS time.

The system clocks, including those of Python's `time` module, show ROS time, or time at another rate if one is given.
Each reading advances them by 10 µs, so that a loop that waits for time to pass ends. Other code, such as rclpy's or
Python's own, reads the real clocks. Sleeping, with `time` or with a clock of rclpy, lets ROS time pass.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.time import Time
from rclpy.utilities import get_default_context

READING_NS = 10_000  # by how much each reading advances the system clocks
_LIBRARY_PATHS = tuple({sys.prefix, sys.base_prefix, "/usr", "/opt/ros", "<frozen"})
_clock_now = Clock.now
_clock_sleep_until = Clock.sleep_until


class Clocks:
    """The program's clocks.

    Args:
        ros_time: returns ROS time in nanoseconds.
        sleep: lets nanoseconds of ROS time pass, or returns False if the machine's time has to pass instead.
        host: the host's own folder, whose code reads the real clocks.
        rate: how many seconds the system clocks advance per second of ROS time.
    """

    def __init__(self, ros_time: Callable[[], int], sleep: Callable[[int], bool], host: str, rate: float = 1.0) -> None:
        self._ros_time = ros_time
        self._sleep = sleep
        self._host = host
        self._rate = rate
        self._start = ros_time()
        self._last = 0

    def install(self) -> None:
        """Replace the clocks of Python and rclpy."""
        for name in ("time", "monotonic", "perf_counter"):
            self._replace(name, lambda: self.read() / 1e9)
            self._replace(f"{name}_ns", self.read)
        machine_sleep = time.sleep

        def sleep(seconds: float) -> None:
            if not self._sleep(round(seconds * 1e9 / self._rate)):
                machine_sleep(seconds)

        # The parameters have rclpy's names, because a program may pass them by name.
        def sleep_until(clock: Any, until: Time, context: Any = None) -> bool:
            context = context or get_default_context()
            if not context.ok() or until.clock_type != clock.clock_type:
                return bool(_clock_sleep_until(clock, until, context))  # raises the error
            remaining_ns = max(0, until.nanoseconds - self._time_of(clock))
            sleep(remaining_ns / 1e9 * (self._rate if clock.clock_type == ClockType.ROS_TIME else 1.0))
            return bool(context.ok())

        def sleep_for(clock: Any, rel_time: Any, context: Any = None) -> bool:
            end = self._time_of(clock) + rel_time.nanoseconds
            return sleep_until(clock, Time(nanoseconds=end, clock_type=clock.clock_type), context)

        setattr(time, "sleep", sleep)  # noqa: B010 - a type checker rejects another function
        Clock.now = lambda clock: self._now(clock)
        Clock.sleep_until = sleep_until
        Clock.sleep_for = sleep_for

    def read(self) -> int:
        """Return the time of the system clocks in nanoseconds, which is later at each call."""
        now = self._start + round((self._ros_time() - self._start) * self._rate)
        self._last = max(self._last + READING_NS, now)
        return self._last

    def _time_of(self, clock: Any) -> int:
        """Return the time of a clock of the program in nanoseconds."""
        return self._ros_time() if clock.clock_type == ClockType.ROS_TIME else self.read()

    def _replace(self, name: str, stepped: Callable[[], Any]) -> None:
        machine = getattr(time, name)

        def read() -> Any:
            return stepped() if self._is_student_frame(sys._getframe(1)) else machine()

        setattr(time, name, read)

    def _now(self, clock: Any) -> Time:
        if clock.clock_type == ClockType.ROS_TIME or not self._is_student_frame(sys._getframe(2)):
            return _clock_now(clock)
        return Time(nanoseconds=self.read(), clock_type=clock.clock_type)

    def _is_student_frame(self, frame: Any) -> bool:
        return not frame.f_code.co_filename.startswith((*_LIBRARY_PATHS, self._host))
