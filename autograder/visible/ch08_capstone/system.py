"""The student's three programs, shown scans and asked for what they say."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from typing import Any

from geometry_msgs.msg import Twist
from sensor_msgs.msg import LaserScan

from autograder.checks import CheckFailed, expect
from autograder.lab import LockstepLab, Stamped, Workspace
from autograder.probes.parameters import NodeParameters
from autograder.visible.ch02_nodes.robot import say
from autograder.visible.ch08_capstone.contract import (
    CONTROLLER,
    LEVELS,
    MONITOR,
    PACKAGE,
    PROCESSOR,
    TOLERANCE,
    name_of,
)
from autograder.visible.ch08_capstone.messages import Types

SCAN_SECONDS = 0.1
SETTLED = 0.35  # s: a scan has gone through both nodes by then, and a command at 10 Hz has followed
ANSWER_SECONDS = 10.0  # s of real time for a service
PATIENCE_NS = 1_000_000  # of ROS time between two looks for its answer
ALONE_SECONDS = 1.6  # s at the start without a scan: the first three reports


@dataclass(frozen=True)
class Said:
    """What the system said during a stretch of time, each in the order in which it came."""

    clearances: tuple[Stamped, ...]
    commands: tuple[Stamped, ...]
    reports: tuple[Stamped, ...]


class System:
    """The three programs, each in a lab of its own; what one says is passed on to those that listen to it.

    It steps them in the order in which a scan goes through them, so that a scan, the clearance of it and the command
    that follows belong to one step.

    Attributes:
        first: what they said before the first scan.
    """

    tick_ns = round(SCAN_SECONDS * 1e9)

    def __init__(self, workspace: Workspace, types: Types) -> None:
        scan, command = {"/scan": LaserScan}, {"/cmd_vel": Twist}
        clearance, health = {"/clearance": types.clearance}, {"/health": types.health}
        ends = {
            PROCESSOR: (scan, clearance),
            CONTROLLER: (clearance, command),
            MONITOR: ({**scan, **clearance, **command}, health),
        }
        self.labs = {
            program: LockstepLab(workspace, PACKAGE, program, offers=offers, listens=listens)
            for program, (offers, listens) in ends.items()
        }
        self._speaker = {topic: program for program, (_, listens) in ends.items() for topic in listens}
        self._stack = ExitStack()

    def __enter__(self) -> System:
        for lab in self.labs.values():
            self._stack.enter_context(lab)
        self.first = self.wait(ALONE_SECONDS)
        return self

    def __exit__(self, *ending: object) -> None:
        self._stack.close()

    @property
    def alive(self) -> bool:
        """Whether no program has ended."""
        return all(lab.process.ending is None for lab in self.labs.values())

    @property
    def now_ns(self) -> int:
        """ROS time in nanoseconds."""
        return self.labs[PROCESSOR].now_ns

    @property
    def seconds(self) -> float:
        """Seconds of ROS time since the programs started."""
        return self.labs[PROCESSOR].seconds

    @property
    def output(self) -> str:
        """What the programs have printed and logged so far."""
        return "".join(lab.output for lab in self.labs.values())

    def publish(self, topic: str, message: Any) -> None:
        """Publish a message to every program that takes it."""
        for lab in self.labs.values():
            lab.publish(topic, message)

    def step(self, dt_ns: int) -> None:
        """Let the programs live through the next `dt_ns` nanoseconds of ROS time."""
        for program, lab in self.labs.items():
            before = {topic: len(lab.messages(topic)) for topic, name in self._speaker.items() if name == program}
            lab.step(dt_ns)
            for topic, count in before.items():
                for said in lab.messages(topic)[count:]:
                    self.publish(topic, said.message)

    def run(self, seconds: float) -> None:
        """Let the programs live through `seconds` of ROS time, tick by tick."""
        for _ in range(round(seconds / SCAN_SECONDS)):
            self.step(self.tick_ns)

    def messages(self, topic: str, *, since: float = -math.inf, until: float = math.inf) -> list[Stamped]:
        """Return what was published on `topic` after `since` and up to `until`, in seconds of ROS time."""
        return self.labs[self._speaker[topic]].messages(topic, since=since, until=until)

    def call(self, kind: Any, service: str, request: Any) -> Any:
        """Call a service of one of the programs and return its response, while time goes on for all of them.

        Raises:
            CheckFailed: there is no such service, or it does not answer.
        """
        lab = next((lab for lab in self.labs.values() if service in _services(lab)), None)
        if lab is None:
            raise CheckFailed(f"There is no service {service}.")
        client = lab.node.create_client(kind, service)
        try:
            lab.wait_for(client.service_is_ready, ANSWER_SECONDS)
            number = client.handle.send_request(request)
            deadline = time.monotonic() + ANSWER_SECONDS
            while time.monotonic() < deadline:
                header, response = client.handle.take_response(kind.Response)
                if header is not None and header.request_id.sequence_number == number:
                    return response
                self.step(PATIENCE_NS)
        finally:
            lab.node.destroy_client(client)
        raise CheckFailed(f"The service {service} did not answer within {ANSWER_SECONDS:.0f} s.")

    def parameters(self, program: str) -> NodeParameters:
        """Return the parameters of a program's node; time goes on for all programs while they are asked for."""
        return NodeParameters(_Together(self, self.labs[program]), name_of(program))  # type: ignore[arg-type]

    def see(self, scan: LaserScan, seconds: float = 1.0, *, age: float = 0.0) -> Said:
        """Show a scan ten times a second; return what is said once there was time to react.

        Args:
            scan: what the lidar sees.
            seconds: for how long.
            age: how old the scans' stamps are when they come.
        """
        began = self.seconds
        for _ in range(round(seconds / SCAN_SECONDS)):
            self.show(scan, age)
        return self.said(began + SETTLED)

    def show(self, scan: LaserScan, age: float = 0.0) -> None:
        """Show one scan and let 0.1 s pass."""
        stamp = self.now_ns + round((SCAN_SECONDS - age) * 1e9) - 1
        scan.header.stamp.sec, scan.header.stamp.nanosec = divmod(stamp, 10**9)
        self.publish("/scan", scan)
        self.run(SCAN_SECONDS)

    def wait(self, seconds: float) -> Said:
        """Show nothing for a while; return what was said in that time."""
        began = self.seconds
        self.run(seconds)
        return self.said(began)

    def said(self, since: float, until: float = math.inf) -> Said:
        """Return what was said after `since`, in seconds of ROS time, and up to `until`."""
        topics = ("/clearance", "/cmd_vel", "/health")
        return Said(*(tuple(self.messages(topic, since=since, until=until)) for topic in topics))


@dataclass(frozen=True)
class _Together:
    """One program's lab, in which a step is a step of all programs."""

    system: System
    lab: LockstepLab

    @property
    def node(self) -> Any:
        """The grader's node that meets the program."""
        return self.lab.node

    def wait_for(self, condition: Callable[[], bool], seconds: float) -> bool:
        """Listen until the condition holds."""
        return self.lab.wait_for(condition, seconds)

    def step(self, dt_ns: int) -> None:
        """Let time go on for all."""
        self.system.step(dt_ns)


def _services(lab: LockstepLab) -> dict[str, list[str]]:
    return dict(lab.node.get_service_names_and_types())


def expect_still(commands: Sequence[Stamped], situation: str, *, fraction: float = 0.0) -> None:
    """Fail the check unless every command is zero."""
    expect(bool(commands), f"{situation}, no command came on cmd_vel: the robot should be told to stand still.")
    bad = next((c for c in commands if not (_near(c.message.linear.x, 0.0) and _near(c.message.angular.z, 0.0))), None)
    did = "" if bad is None else say(bad.message)
    expect(bad is None, f"{situation}, the robot {did}: it should stand still.", fraction=fraction)


def expect_driving(commands: Sequence[Stamped], situation: str, fastest: float, *, fraction: float = 0.0) -> None:
    """Fail the check unless every command drives forward, at most at `fastest` m/s."""
    expect(bool(commands), f"{situation}, no command came on cmd_vel: the robot should drive.")
    bad = next((c for c in commands if not 0.0 < c.message.linear.x <= fastest + TOLERANCE), None)
    did = "" if bad is None else say(bad.message)
    expect(
        bad is None,
        f"{situation}, the robot {did}: it should drive forward, at most at {fastest:.2f} m/s.",
        fraction=fraction,
    )


def expect_turning(
    commands: Sequence[Stamped], situation: str, side: str, fastest: float, *, fraction: float = 0.0
) -> None:
    """Fail the check unless every command turns on the spot to a side, at most at `fastest` rad/s."""
    expect(bool(commands), f"{situation}, no command came on cmd_vel: the robot should turn.")
    sign = 1.0 if side == "left" else -1.0
    bad = next(
        (
            c
            for c in commands
            if not (_near(c.message.linear.x, 0.0) and 0.0 < sign * c.message.angular.z <= fastest + TOLERANCE)
        ),
        None,
    )
    did = "" if bad is None else say(bad.message)
    expect(
        bad is None,
        f"{situation}, the robot {did}: it should turn {side} on the spot, at most at {fastest:.2f} rad/s.",
        fraction=fraction,
    )


def report_in_words(report: Any) -> str:
    """Put a report of the monitor into words."""
    level = LEVELS[report.level] if 0 <= report.level < len(LEVELS) else str(report.level)
    silent = ", ".join(str(topic)[:40] for topic in list(report.silent)[:5]) or "none"
    return f"level {level}, silent: {silent}"


def _near(value: float, wanted: float) -> bool:
    return abs(value - wanted) <= TOLERANCE  # false for nan
