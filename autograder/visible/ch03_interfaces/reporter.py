"""The student's status publisher in the lab, with the sensors that it sums up."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from sensor_msgs.msg import BatteryState, JointState

from autograder.checks import expect
from autograder.lab import LockstepLab, Workspace
from autograder.visible.ch03_interfaces.contract import PACKAGE, STATUS
from autograder.visible.ch03_interfaces.types import Types

BATTERY, JOINTS, TOPIC, SERVICE = "/battery_state", "/joint_states", "/robot_status", "/check_trip"
OFFERS = {BATTERY: BatteryState, JOINTS: JointState}
PERIOD = 1.0  # s between two messages, unless the parameter says otherwise


class Reporter(LockstepLab):
    """A lab in which sensors speak, and the status is read."""

    def __init__(self, workspace: Workspace, types: Types, arguments: tuple[str, ...] = ()) -> None:
        listens = {TOPIC: types.robot_status}
        super().__init__(workspace, PACKAGE, STATUS, offers=OFFERS, listens=listens, arguments=arguments)
        self.types = types

    def tell(self, percentage: float, *, charging: bool = False) -> None:
        """Let the battery speak, from 0.0 to 1.0; the message is on its way until time goes on."""
        status = BatteryState.POWER_SUPPLY_STATUS_CHARGING if charging else BatteryState.POWER_SUPPLY_STATUS_DISCHARGING
        self.publish(BATTERY, BatteryState(percentage=percentage, power_supply_status=status))

    def pose(self, positions: Sequence[float]) -> None:
        """Let the joints speak."""
        names = [f"joint_{number}" for number in range(len(positions))]
        self.publish(JOINTS, JointState(name=names, position=list(positions)))

    def status(self) -> Any:
        """Return the status that comes next; fail the check if none does."""
        began = self.seconds
        self.run(PERIOD + 0.2)
        heard = self.messages(TOPIC, since=began)
        expect(bool(heard), "No message came on robot_status for more than a second.")
        return heard[-1].message


def same(one: float, other: float) -> bool:
    """Return whether a number came through a float32, or nearly."""
    return math.isclose(one, other, rel_tol=1e-6, abs_tol=1e-9)
