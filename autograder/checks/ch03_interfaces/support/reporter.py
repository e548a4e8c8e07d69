"""The student's status publisher in a harness that publishes the messages of its sensors."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from rclpy.time import Time
from sensor_msgs.msg import BatteryState, JointState
from std_msgs.msg import Header

from autograder.checking import AutoHarness, Workspace, expect
from autograder.checks.ch03_interfaces.support.contract import PACKAGE, RESERVE, STATUS, UNKNOWN
from autograder.checks.ch03_interfaces.support.types import Types

BATTERY, JOINTS, TOPIC, SERVICE = "/battery_state", "/joint_states", "/robot_status", "/check_trip"
PUBLISHES = {BATTERY: BatteryState, JOINTS: JointState}
PERIOD = 1.0  # s between two messages, unless the parameter says otherwise
STAMP_AGE_NS = 700_000_000  # the age of a sensor message's stamp when it is published
EXTRA_SECONDS = 4.0  # s of additional time for a status whose period is too long
SHOWN_SECONDS = 1.5  # s to wait until the status shows a battery's level, which a wrong status never does
ANSWER_SECONDS = 10.0  # s to wait for an answer; in lockstep, the service answers at once


class Reporter(AutoHarness):
    """A harness that publishes sensor messages, reads the status and calls the service."""

    def __init__(
        self, workspace: Workspace, types: Types, arguments: tuple[str, ...] = (), clock_rate: float = 1.0
    ) -> None:
        subscribes = {TOPIC: types.robot_status}
        super().__init__(
            workspace,
            PACKAGE,
            STATUS,
            publishes=PUBLISHES,
            subscribes=subscribes,
            arguments=arguments,
            clock_rate=clock_rate,
        )
        self.types = types

    def publish_battery(self, percentage: float, *, status: int = BatteryState.POWER_SUPPLY_STATUS_DISCHARGING) -> None:
        """Publish a battery state, from 0.0 to 1.0; the message is delivered when time advances."""
        message = BatteryState(header=self._header(), percentage=percentage, power_supply_status=status)
        self.publish(BATTERY, message)

    def publish_joints(self, positions: Sequence[float]) -> None:
        """Publish a joint state with these positions."""
        names = [f"joint_{number}" for number in range(len(positions))]
        self.publish(JOINTS, JointState(header=self._header(), name=names, position=list(positions)))

    def _header(self) -> Header:
        """Return a header whose stamp is older than a status may be."""
        return Header(stamp=Time(nanoseconds=self.now_ns - STAMP_AGE_NS).to_msg())

    def status(self) -> Any:
        """Return the next status; fail the check if none is published."""
        start = self.seconds
        self.run(PERIOD + 0.2)
        self.until(lambda: bool(self.messages(TOPIC, since=start)), EXTRA_SECONDS)  # another check tests the period
        statuses = self.messages(TOPIC, since=start)
        expect(bool(statuses), f"No message was published on robot_status for {PERIOD + EXTRA_SECONDS:.0f} s.")
        return statuses[-1].message

    def set_battery(self, percent: int, excess: float = 0.25) -> int:
        """Publish a charge of `percent` plus `excess` percent, and wait until the status shows the level `percent`.

        Returns:
            The level that the status shows then, in percent; -1 if no status is published.
        """
        start = self.seconds
        self.publish_battery(min(1.0, (percent + excess) / 100.0))

        def shown_level() -> int:
            statuses = self.messages(TOPIC, since=start)
            return int(statuses[-1].message.battery_level) if statuses else UNKNOWN

        self.until(lambda: shown_level() == percent, SHOWN_SECONDS)
        return shown_level()

    def ask(self, legs: Sequence[float], reserve: int = RESERVE) -> Any:
        """Call the service for a trip and return the response; fail the check if none arrives."""
        request = self.types.check_trip.Request(legs=list(legs), reserve=reserve)
        response = self.call(self.types.check_trip, SERVICE, request, ANSWER_SECONDS)
        expect(response is not None, "check_trip did not answer.")
        return response


def is_same_float32(a: float, b: float) -> bool:
    """Return whether two numbers are equal up to the precision of float32."""
    return math.isclose(a, b, rel_tol=1e-6, abs_tol=1e-9)
