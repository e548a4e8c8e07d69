"""The student's node in the harness: what it sees, what it is told, and how fast it drives."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path

from rcl_interfaces.msg import ParameterDescriptor
from sensor_msgs.msg import BatteryState, LaserScan

from autograder.checking import (
    COMMAND_TOPICS,
    SCAN_SECONDS,
    SENSOR_TOPICS,
    AutoHarness,
    Kind,
    ReceivedMessage,
    StudentError,
    Workspace,
    expect,
)
from autograder.checking.probes import message_period, parameters
from autograder.checks.ch05_parameters.support.contract import CHANGEABLE, EXECUTABLE, FLEET, NODE, PACKAGE, WANTED

BEAMS = 360
SETTLED = 0.2  # s: a node at 10 Hz has answered a scan by then
TOLERANCE = 0.01  # m/s: a speed may be rounded to centimetres
RATE_TOLERANCE = 0.08  # of the rate: in real time commands are late, and an error of a tenth is seen
ROUNDED = 0.0051  # m: a value in a sentence may be rounded to centimetres
STEP_SHARE = 0.05  # of a parameter's range: less than from any drawn number of the start to its default
REFUSED = (Kind.CRASHED_AT_START, Kind.ENDED_EARLY)


class Robot(AutoHarness):
    """A harness in which the node sees distances, hears of its battery, and has parameters.

    Attributes:
        parameters: those of the node.
    """

    def __init__(
        self,
        workspace: Workspace,
        values: Mapping[str, parameters.Value] | None = None,
        *,
        arguments: Sequence[str] = (),
        name: str = NODE,
    ) -> None:
        publishes = {**SENSOR_TOPICS, "/battery_state": BatteryState}
        super().__init__(
            workspace,
            PACKAGE,
            EXECUTABLE,
            publishes=publishes,
            subscribes=COMMAND_TOPICS,
            arguments=("--ros-args", *parameters.override_arguments(values or {}), *arguments),
        )
        self.parameters = parameters.NodeParameters(self, name)

    @classmethod
    def of_fleet(cls, workspace: Workspace, name: str) -> Robot:
        """Return a harness whose node has a robot's name and the fleet's file."""
        arguments = ("-r", f"__node:={name}", "--params-file", str(fleet_path(workspace)))
        return cls(workspace, arguments=arguments, name=f"/{name}")

    @cached_property
    def initial(self) -> dict[str, parameters.Value]:
        """The values with which it started; to be read before anything is changed."""
        return self.parameters.values(*WANTED)

    @cached_property
    def descriptors(self) -> dict[str, ParameterDescriptor]:
        """What it says of its parameters, by their names."""
        return self.parameters.descriptors(*WANTED)

    def allowed(self, name: str, number: float, *, up: bool = False) -> float:
        """Return the number next below, or above, that a parameter's type and steps allow: one check judges these.

        The node describes its steps itself. Where they lead far from the number, it is returned as it is: otherwise the
        node would choose the values that it is tried with.
        """
        described = self.descriptors.get(name)
        if described is None:
            return number
        ranges = [*described.floating_point_range, *described.integer_range]
        low, step = (float(ranges[0].from_value), float(ranges[0].step)) if ranges else (0.0, 0.0)
        is_whole = type(self.initial.get(name)) is int
        if is_whole:
            step = max(1.0, step)
        if not step > 0.0:
            return number
        steps = (number - low) / step
        near = round(low + (math.ceil(steps - 1e-6) if up else math.floor(steps + 1e-6)) * step, 9)
        return near if abs(near - number) < farthest(name, is_whole=is_whole) else number

    def unfixed(self, values: Mapping[str, parameters.Value]) -> dict[str, parameters.Value]:
        """Return those of these values whose parameters are not read-only; one check judges which are."""
        described = self.descriptors
        return {name: value for name, value in values.items() if name not in described or not described[name].read_only}

    def change(self, values: Mapping[str, parameters.Value]) -> parameters.SetParametersReply:
        """Ask for a change of several parameters in one request, numbers in the types that the node declares."""
        return self.parameters.change(parameters.as_declared(values, self.initial))

    def see(self, distance: float, seconds: float = 0.5) -> list[ReceivedMessage]:
        """Show a wall at `distance` metres straight ahead, ten times a second; return the commands once settled."""
        began = self.seconds
        for _ in range(round(seconds / SCAN_SECONDS)):
            self.publish("/scan", scan(distance))
            self.live(SCAN_SECONDS)
        return self.messages("/cmd_vel", since=began + SETTLED)

    def live(self, seconds: float) -> None:
        """Let time pass in steps that hit each period that a change may bring; `run` hits those of the start."""
        for _ in range(round(seconds * 1e9) // self.finest_tick_ns):
            self.step(self.finest_tick_ns)

    def speed_at(self, distance: float) -> float:
        """Return the speed in m/s that the node settles on, nan without a command."""
        commands = self.see(distance)
        return float(commands[-1].message.linear.x) if commands else math.nan

    def command_rate(self, seconds: float = 2.0) -> float:
        """Return how many commands a second come while the way is clear."""
        self.see(3.0, 0.3)  # a period that has just been changed counts from now on
        began = self.seconds
        self.see(3.0, seconds)
        return self.rate_since(began)

    def rate_since(self, began: float) -> float:
        """Return how many commands a second came after `began`, by the mean time between them."""
        period = message_period.mean_period(self.messages("/cmd_vel", since=began))
        return 1.0 / period if period else math.inf

    def charge(self, percent: float) -> None:
        """Let the battery say its charge."""
        self.publish("/battery_state", BatteryState(percentage=percent / 100.0))


def farthest(name: str, *, is_whole: bool = False) -> float:
    """Return how far a parameter's steps may move a drawn number; whole numbers are up to 1 away."""
    low, high = WANTED[name].low, WANTED[name].high
    assert low is not None, name
    assert high is not None, name
    return max(STEP_SHARE * (high - low), 1.0 if is_whole else 0.0)


def restore(robot: Robot) -> bool:
    """Set the parameters that can be changed to the values of the contract; return whether the node has them."""
    wanted = parameters.as_declared(
        {name: CHANGEABLE[name] for name in CHANGEABLE if name in robot.initial}, robot.initial
    )
    found = robot.parameters.values(*wanted)
    return not parameters.differences(found, wanted) or robot.parameters.change(wanted).accepted


def refusal(workspace: Workspace, values: Mapping[str, parameters.Value]) -> str | None:
    """Return what a program said when it refused to start with these values, None if it did not refuse.

    Raises:
        StudentError: something else is wrong with it.
    """
    try:
        with Robot(workspace, values):
            return None
    except StudentError as error:
        if error.diagnosis.kind not in REFUSED:
            raise
        return f"{error.diagnosis.sentence}\n{error.diagnosis.detail}"


def fleet_path(workspace: Workspace) -> Path:
    """Return where the fleet's file is installed."""
    return workspace.install / PACKAGE / "share" / PACKAGE / "config" / FLEET


def scan(distance: float) -> LaserScan:
    """Return a scan that reads `distance` within 20 degrees of straight ahead, and 3 m elsewhere."""
    message = LaserScan(angle_increment=math.tau / BEAMS, scan_time=SCAN_SECONDS, range_min=0.12, range_max=3.5)
    message.angle_max = message.angle_increment * (BEAMS - 1)
    message.header.frame_id = "laser"
    message.ranges = [distance if min(beam, BEAMS - beam) <= 20 else 3.0 for beam in range(BEAMS)]
    return message


def missing_from(sentence: str, distances: Mapping[str, float]) -> list[str]:
    """Return the names, and then the values in m, that a sentence about some distances does not hold."""
    numbers = [float(number) for number in re.findall(r"\d+(?:\.\d+)?", sentence)]
    values = distances.values()
    absent = [str(value) for value in values if not any(abs(number - value) < ROUNDED for number in numbers)]
    return [name for name in distances if name not in sentence] + absent


def expect_speed(speed: float, wanted: float, situation: str) -> None:
    """Fail the check unless the speed is the wanted one."""
    expect(not math.isnan(speed), f"{situation}, no command came on /cmd_vel.")
    expect(
        abs(speed - wanted) <= TOLERANCE, f"{situation}, it drove at {speed:.2f} m/s; it should drive at {wanted:.2f}."
    )


def expect_rate(rate: float, wanted: float, situation: str, fraction: float = 0.0) -> None:
    """Fail the check unless commands come at the wanted rate. An error of a tenth is seen."""
    expect(
        abs(rate - wanted) <= RATE_TOLERANCE * wanted,
        f"{situation}, it published {rate:.1f} commands a second; it should publish {wanted:.0f}.",
        fraction=fraction,
    )
