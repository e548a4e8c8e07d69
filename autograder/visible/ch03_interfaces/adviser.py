"""The student's status publisher in the lab, asked about trips."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sensor_msgs.msg import BatteryState

from autograder.checks import expect
from autograder.lab import Workspace
from autograder.visible.ch03_interfaces.contract import PACKAGE, RESERVE, STATUS
from autograder.visible.ch03_interfaces.reporter import BATTERY, SERVICE, TOPIC
from autograder.visible.ch03_interfaces.talk import TalkingLab
from autograder.visible.ch03_interfaces.types import Types

HEARD_SECONDS = 1.5  # of real time until a battery that has spoken shows in the status; a status may be wrong, too
QUICK = ("--ros-args", "-p", "status_period:=0.05")


class Adviser(TalkingLab):
    """A lab in which the battery speaks, and trips are asked about."""

    def __init__(self, workspace: Workspace, types: Types) -> None:
        listens = {TOPIC: types.robot_status}
        super().__init__(workspace, PACKAGE, STATUS, offers={BATTERY: BatteryState}, listens=listens, arguments=QUICK)
        self.types = types

    def level(self, percent: int) -> None:
        """Set the battery's level; wait until the status shows that the program has heard of it."""
        self.publish(BATTERY, BatteryState(percentage=min(1.0, (percent + 0.25) / 100.0)))
        self.listen_until(
            lambda: any(stamped.message.battery_level == percent for stamped in self.messages(TOPIC)[-1:]),
            HEARD_SECONDS,
        )

    def ask(self, legs: Sequence[float], reserve: int = RESERVE) -> Any:
        """Ask about a trip; return the response, fail the check if none comes."""
        request = self.types.check_trip.Request(legs=list(legs), reserve=reserve)
        answer = self.ask_service(self.types.check_trip, SERVICE, request)
        expect(answer is not None, "check_trip did not answer.")
        return answer
