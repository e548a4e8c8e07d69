"""The student's status publisher in the harness, with the sensors that it sums up."""

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
STALE_NS = 700_000_000  # how old what a sensor says is when it is said
SLOW_SECONDS = 4.0  # more, for a status whose period is too long
HEARD_SECONDS = 1.5  # until a battery that has spoken shows in the status; a status may be wrong, too
ANSWER_SECONDS = 10.0  # for a service to answer: no time at all in lockstep, generous where time is real


class Reporter(AutoHarness):
    """A harness in which sensors speak, the status is read, and trips are asked about."""

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
        """Let the battery speak, from 0.0 to 1.0; the message is on its way until time goes on."""
        message = BatteryState(header=self._header(), percentage=percentage, power_supply_status=status)
        self.publish(BATTERY, message)

    def publish_joints(self, positions: Sequence[float]) -> None:
        """Let the joints speak."""
        names = [f"joint_{number}" for number in range(len(positions))]
        self.publish(JOINTS, JointState(header=self._header(), name=names, position=list(positions)))

    def _header(self) -> Header:
        """Return a header whose stamp is older than a status may be."""
        return Header(stamp=Time(nanoseconds=self.now_ns - STALE_NS).to_msg())

    def status(self) -> Any:
        """Return the status that comes next; fail the check if none does."""
        began = self.seconds
        self.run(PERIOD + 0.2)
        self.until(lambda: bool(self.messages(TOPIC, since=began)), SLOW_SECONDS)  # another check asks for its period
        heard = self.messages(TOPIC, since=began)
        expect(bool(heard), f"No message came on robot_status for {PERIOD + SLOW_SECONDS:.0f} s.")
        return heard[-1].message

    def set_battery(self, percent: int, over: float = 0.25) -> int:
        """Charge the battery to a level, `over` percent more; wait until the status shows that the program knows it.

        Returns:
            The level that the status shows then, in percent; -1 if no status comes.
        """
        began = self.seconds
        self.publish_battery(min(1.0, (percent + over) / 100.0))

        def shown() -> int:
            heard = self.messages(TOPIC, since=began)
            return int(heard[-1].message.battery_level) if heard else UNKNOWN

        self.until(lambda: shown() == percent, HEARD_SECONDS)
        return shown()

    def ask(self, legs: Sequence[float], reserve: int = RESERVE) -> Any:
        """Ask about a trip; return the response, fail the check if none comes."""
        request = self.types.check_trip.Request(legs=list(legs), reserve=reserve)
        answer = self.call(self.types.check_trip, SERVICE, request, ANSWER_SECONDS)
        expect(answer is not None, "check_trip did not answer.")
        return answer


def same(one: float, other: float) -> bool:
    """Return whether a number came through a float32, or nearly."""
    return math.isclose(one, other, rel_tol=1e-6, abs_tol=1e-9)
