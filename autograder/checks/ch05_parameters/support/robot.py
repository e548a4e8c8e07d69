"""The student's node in the harness: its scans, its parameters and its speed."""

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
from autograder.checks.ch05_parameters.support.contract import (
    CHANGEABLE,
    EXECUTABLE,
    FLEET,
    NODE,
    PACKAGE,
    SPECIFICATIONS,
)

BEAMS = 360
SETTLE_SECONDS = 0.2  # s: by then, a node at 10 Hz has reacted to a scan
TOLERANCE = 0.01  # m/s: a speed may be rounded to centimetres
RATE_TOLERANCE = 0.08  # as a share of the rate: commands are late in real time, and 10 % must be detected
ROUNDED = 0.0051  # m: a value in a sentence may be rounded to centimetres
STEP_SHARE = 0.05  # as a share of a parameter's range: any drawn start value differs more from the default
REFUSAL_KINDS = (Kind.CRASHED_AT_START, Kind.ENDED_EARLY)


class Robot(AutoHarness):
    """A harness in which the node receives scans and battery states, and has parameters.

    Attributes:
        parameters: the parameters of the node.
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
        """Return a harness whose node has the name of a robot and reads the fleet's parameter file."""
        arguments = ("-r", f"__node:={name}", "--params-file", str(fleet_path(workspace)))
        return cls(workspace, arguments=arguments, name=f"/{name}")

    @cached_property
    def initial(self) -> dict[str, parameters.Value]:
        """The values with which the node started. Read them before any change."""
        return self.parameters.values(*SPECIFICATIONS)

    @cached_property
    def descriptors(self) -> dict[str, ParameterDescriptor]:
        """The node's descriptors of its parameters, by name."""
        return self.parameters.descriptors(*SPECIFICATIONS)

    def allowed(self, name: str, number: float, *, up: bool = False) -> float:
        """Return the nearest number below, or with `up` above, that a parameter's type and steps allow.

        A single check tests type and steps, so that no other check fails because of them. The node describes its steps
        itself. If the nearest number is far away, `number` is returned unchanged: otherwise the node could choose the
        values with which it is tested.
        """
        descriptor = self.descriptors.get(name)
        if descriptor is None:
            return number
        ranges = [*descriptor.floating_point_range, *descriptor.integer_range]
        low, step = (float(ranges[0].from_value), float(ranges[0].step)) if ranges else (0.0, 0.0)
        is_whole = type(self.initial.get(name)) is int
        if is_whole:
            step = max(1.0, step)
        if not step > 0.0:
            return number
        steps = (number - low) / step
        nearest = round(low + (math.ceil(steps - 1e-6) if up else math.floor(steps + 1e-6)) * step, 9)
        return nearest if abs(nearest - number) < max_shift(name, is_whole=is_whole) else number

    def without_read_only(self, values: Mapping[str, parameters.Value]) -> dict[str, parameters.Value]:
        """Return the values of parameters that are not read-only. Another check tests which ones are read-only."""
        descriptors = self.descriptors
        return {
            name: value for name, value in values.items() if name not in descriptors or not descriptors[name].read_only
        }

    def change(self, values: Mapping[str, parameters.Value]) -> parameters.SetParametersReply:
        """Set parameters in one request, with numbers in the types that the node declares."""
        return self.parameters.change(parameters.as_declared(values, self.initial))

    def show_wall(self, distance: float, seconds: float = 0.5) -> list[ReceivedMessage]:
        """Publish scans of a wall `distance` metres straight ahead; return the commands after `SETTLE_SECONDS`."""
        start = self.seconds
        for _ in range(round(seconds / SCAN_SECONDS)):
            self.publish("/scan", scan(distance))
            self.advance(SCAN_SECONDS)
        return self.messages("/cmd_vel", since=start + SETTLE_SECONDS)

    def advance(self, seconds: float) -> None:
        """Let time pass in steps fine enough for any new timer period; `run` suits only the periods at the start."""
        for _ in range(round(seconds * 1e9) // self.finest_tick_ns):
            self.step(self.finest_tick_ns)

    def speed_at(self, distance: float) -> float:
        """Return the speed in m/s on which the node settles; nan if no command is published."""
        commands = self.show_wall(distance)
        return float(commands[-1].message.linear.x) if commands else math.nan

    def command_rate(self, seconds: float = 2.0) -> float:
        """Return the number of commands per second while the way is clear."""
        self.show_wall(3.0, 0.3)  # after a change of the timer, the new period starts here
        start = self.seconds
        self.show_wall(3.0, seconds)
        return self.rate_since(start)

    def rate_since(self, start: float) -> float:
        """Return the number of commands per second after `start`, from the mean time between them."""
        period = message_period.mean_period(self.messages("/cmd_vel", since=start))
        return 1.0 / period if period else math.inf

    def publish_charge(self, percent: float) -> None:
        """Publish the battery's charge."""
        self.publish("/battery_state", BatteryState(percentage=percent / 100.0))


def max_shift(name: str, *, is_whole: bool = False) -> float:
    """Return how far a parameter's steps may shift a drawn number; at least 1 for whole numbers."""
    low, high = SPECIFICATIONS[name].low, SPECIFICATIONS[name].high
    assert low is not None, name
    assert high is not None, name
    return max(STEP_SHARE * (high - low), 1.0 if is_whole else 0.0)


def restore(robot: Robot) -> bool:
    """Set the changeable parameters to the contract's defaults; return whether the node has these values."""
    defaults = parameters.as_declared(
        {name: CHANGEABLE[name] for name in CHANGEABLE if name in robot.initial}, robot.initial
    )
    values = robot.parameters.values(*defaults)
    return not parameters.differences(values, defaults) or robot.parameters.change(defaults).accepted


def start_error(workspace: Workspace, values: Mapping[str, parameters.Value]) -> str | None:
    """Return the error of a program that refuses to start with these values; None if it starts.

    Raises:
        StudentError: the program fails for another reason.
    """
    try:
        with Robot(workspace, values):
            return None
    except StudentError as error:
        if error.diagnosis.kind not in REFUSAL_KINDS:
            raise
        return f"{error.diagnosis.sentence}\n{error.diagnosis.detail}"


def fleet_path(workspace: Workspace) -> Path:
    """Return the path of the fleet's installed parameter file."""
    return workspace.install / PACKAGE / "share" / PACKAGE / "config" / FLEET


def scan(distance: float) -> LaserScan:
    """Return a scan with `distance` within 20 degrees of straight ahead, and 3 m elsewhere."""
    message = LaserScan(angle_increment=math.tau / BEAMS, scan_time=SCAN_SECONDS, range_min=0.12, range_max=3.5)
    message.angle_max = message.angle_increment * (BEAMS - 1)
    message.header.frame_id = "laser"
    message.ranges = [distance if min(beam, BEAMS - beam) <= 20 else 3.0 for beam in range(BEAMS)]
    return message


def missing_from(sentence: str, distances: Mapping[str, float]) -> list[str]:
    """Return the names, and then the values in m, that a sentence about distances does not contain."""
    numbers = [float(number) for number in re.findall(r"\d+(?:\.\d+)?", sentence)]
    values = distances.values()
    missing_values = [str(value) for value in values if not any(abs(number - value) < ROUNDED for number in numbers)]
    return [name for name in distances if name not in sentence] + missing_values


def expect_speed(speed: float, expected: float, situation: str) -> None:
    """Fail the check unless the speed is the expected one."""
    expect(not math.isnan(speed), f"{situation}, no command was published on /cmd_vel.")
    expect(
        abs(speed - expected) <= TOLERANCE,
        f"{situation}, it drove at {speed:.2f} m/s; it should drive at {expected:.2f}.",
    )


def expect_rate(rate: float, expected: float, situation: str, fraction: float = 0.0) -> None:
    """Fail the check unless the rate is the expected one. An error of 10 % fails the check."""
    expect(
        abs(rate - expected) <= RATE_TOLERANCE * expected,
        f"{situation}, it published {rate:.1f} commands per second; it should publish {expected:.0f}.",
        fraction=fraction,
    )
