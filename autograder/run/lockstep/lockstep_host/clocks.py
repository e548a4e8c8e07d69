"""Clocks: every clock that the student's code reads depends on ROS time alone.

The machine's clocks, those of Python's `time` module too, show ROS time unless they are told to run at another rate.
Each reading of them takes 10 µs, so a loop that waits for time to pass ends. Other code, such as rclpy's or Python's
own, reads the true ones. Sleeping, by `time` or by a clock of rclpy's, lets ROS time pass.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.time import Time
from rclpy.utilities import get_default_context

READING = 10_000  # ns that one reading takes
_OTHERS = tuple({sys.prefix, sys.base_prefix, "/usr", "/opt/ros", "<frozen"})
_clock_now = Clock.now
_clock_sleep_until = Clock.sleep_until


class Clocks:
    """The program's clocks.

    Args:
        ros_time: returns ROS time in nanoseconds.
        sleep: lets as many nanoseconds of ROS time pass; returns False where the machine's time has to pass instead.
        host: the host's own folder, whose code keeps the machine's clocks.
        rate: seconds that the machine's clocks count in a second of ROS time.
    """

    def __init__(self, ros_time: Callable[[], int], sleep: Callable[[int], bool], host: str, rate: float = 1.0) -> None:
        self._ros_time = ros_time
        self._sleep = sleep
        self._host = host
        self._rate = rate
        self._start = ros_time()
        self._last = 0

    def install(self) -> None:
        """Put the clocks into Python and rclpy."""
        for name in ("time", "monotonic", "perf_counter"):
            self._replace(name, lambda: self.read() / 1e9)
            self._replace(f"{name}_ns", self.read)
        machine_sleep = time.sleep

        def sleep(seconds: float) -> None:
            if not self._sleep(round(seconds * 1e9 / self._rate)):
                machine_sleep(seconds)

        # The parameters have rclpy's names, since a program may pass them by name.
        def sleep_until(clock: Any, until: Time, context: Any = None) -> bool:
            context = context or get_default_context()
            if not context.ok() or until.clock_type != clock.clock_type:
                return bool(_clock_sleep_until(clock, until, context))  # which raises
            left = max(0, until.nanoseconds - self._shown(clock))
            sleep(left / 1e9 * (self._rate if clock.clock_type == ClockType.ROS_TIME else 1.0))
            return bool(context.ok())

        def sleep_for(clock: Any, rel_time: Any, context: Any = None) -> bool:
            end = self._shown(clock) + rel_time.nanoseconds
            return sleep_until(clock, Time(nanoseconds=end, clock_type=clock.clock_type), context)

        setattr(time, "sleep", sleep)  # noqa: B010 - the name has a type that no stand-in has
        Clock.now = lambda clock: self._now(clock)
        Clock.sleep_until = sleep_until
        Clock.sleep_for = sleep_for

    def read(self) -> int:
        """Return the time of the machine's clocks in nanoseconds, a little later each time."""
        now = self._start + round((self._ros_time() - self._start) * self._rate)
        self._last = max(self._last + READING, now)
        return self._last

    def _shown(self, clock: Any) -> int:
        """Return what a clock of the program's shows."""
        return self._ros_time() if clock.clock_type == ClockType.ROS_TIME else self.read()

    def _replace(self, name: str, stepped: Callable[[], Any]) -> None:
        machine = getattr(time, name)

        def read() -> Any:
            return stepped() if self._is_student(sys._getframe(1)) else machine()

        setattr(time, name, read)

    def _now(self, clock: Any) -> Time:
        if clock.clock_type == ClockType.ROS_TIME or not self._is_student(sys._getframe(2)):
            return _clock_now(clock)
        return Time(nanoseconds=self.read(), clock_type=clock.clock_type)

    def _is_student(self, frame: Any) -> bool:
        return not frame.f_code.co_filename.startswith((*_OTHERS, self._host))
