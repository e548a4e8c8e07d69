"""The student's three programs, shown scans and asked for what they say."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from geometry_msgs.msg import Twist
from sensor_msgs.msg import LaserScan

from autograder.checking import (
    SCAN_SECONDS,
    AutoHarness,
    CheckFailed,
    Process,
    Program,
    ReceivedMessage,
    Shared,
    Workspace,
    expect,
)
from autograder.checking.probes import installed, parameters
from autograder.checks.ch02_nodes.support.robot import describe_command
from autograder.checks.ch08_capstone.support.clearances import right_clearance
from autograder.checks.ch08_capstone.support.contract import (
    CONTROLLER,
    LEVELS,
    PACKAGE,
    PROCESSOR,
    PROGRAMS,
    TOLERANCE,
    name_of,
)
from autograder.checks.ch08_capstone.support.messages import Types, load_messages, types

SETTLED = 0.35  # s: a scan has gone through both nodes by then, and a command at 10 Hz has followed
ANSWER_SECONDS = 5.0  # s of ROS time for a service
ALONE_SECONDS = 1.6  # s at the start without a scan: the first three reports


@dataclass(frozen=True)
class Received:
    """The messages of the system during a stretch of time, in the order in which they came."""

    clearances: tuple[ReceivedMessage, ...]
    commands: tuple[ReceivedMessage, ...]
    reports: tuple[ReceivedMessage, ...]


class System:
    """The three programs; stepped together, a scan, its clearance and the command that follows belong to one step.

    Args:
        workspace: where they are installed.
        types: of the student's messages.
        needed: those without which it is of no use; the others may be missing, or fail.
        clock_rate: seconds that the programs' machine counts in a second of ROS time; always 1 in real time.
        absent: programs that are not started; what they publish can be sent in their place.
        stands_in: whether the right clearance of each scan is sent in the place of an absent sensor_processor.

    Attributes:
        harness: where they run.
        types: of the student's messages.
        first: what they said before the first scan.
    """

    def __init__(
        self,
        workspace: Workspace,
        types: Types,
        needed: Collection[str] = PROGRAMS,
        clock_rate: float = 1.0,
        absent: Collection[str] = (),
        *,
        stands_in: bool = False,
    ) -> None:
        self.types, self._stands_in = types, stands_in and PROCESSOR in absent
        published = {PROCESSOR: ("/clearance", types.clearance), CONTROLLER: ("/cmd_vel", Twist)}
        there = [n for n in PROGRAMS if n not in absent and (n in needed or _is_installed(workspace, n))]
        self.harness = AutoHarness(
            workspace,
            programs=tuple(Program(PACKAGE, name) for name in there),
            publishes={"/scan": LaserScan, **dict(published[name] for name in published if name in absent)},
            subscribes={"/clearance": types.clearance, "/cmd_vel": Twist, "/health": types.health},
            clock_rate=clock_rate,
        )
        self.need(needed)

    def __enter__(self) -> System:
        self.harness.__enter__()
        try:
            self.first = self.wait(ALONE_SECONDS)
        except BaseException:
            self.harness.__exit__(None, None, None)
            raise
        return self

    def __exit__(self, *ending: object) -> None:
        self.harness.__exit__(None, None, None)

    def need(self, needed: Collection[str]) -> None:
        """Say without which programs it is of no use from now on."""
        self.harness.optional = frozenset(PROGRAMS) - frozenset(needed)

    def serves(self, needed: Collection[str]) -> bool:
        """Return whether these programs are there."""
        return self.harness.running.issuperset(needed)

    @property
    def processes(self) -> tuple[Process, ...]:
        """The sandboxed programs."""
        return self.harness.processes

    @property
    def seconds(self) -> float:
        """Seconds of ROS time since the programs started."""
        return self.harness.seconds

    def call(self, kind: Any, service: str, request: Any) -> Any:
        """Call a service of one of the programs and return its response.

        Raises:
            CheckFailed: there is no such service, or it does not answer.
        """
        response = self.harness.call(kind, service, request, ANSWER_SECONDS)
        if response is None:
            raise CheckFailed(f"The service {service} did not answer within {ANSWER_SECONDS:.0f} s.")
        return response

    def parameters_of(self, program: str) -> parameters.NodeParameters:
        """Return the parameters of a program's node."""
        return parameters.NodeParameters(self.harness, name_of(program))

    @contextmanager
    def changed(self, program: str, name: str, value: float) -> Iterator[parameters.SetParametersReply]:
        """Change a parameter for a while; yield the program's reply."""
        asked = self.parameters_of(program)
        before = asked.values(name)
        reply = asked.change({name: value}) if before else parameters.SetParametersReply(accepted=False)
        try:
            yield reply
        finally:
            if reply.accepted:
                asked.change(before)  # what it was, as another check asks whether it is the contract's default

    def see(self, scan: LaserScan, seconds: float = 0.7, *, age: float = 0.0) -> Received:
        """Show a scan ten times a second; return what is said once there was time to react.

        Args:
            scan: what the lidar sees.
            seconds: for how long.
            age: how old the scans' stamps are when they come.
        """
        began = self.seconds
        for _ in range(round(seconds / SCAN_SECONDS)):
            self.show(scan, age)
        return self.messages(began + SETTLED)

    def show(self, scan: LaserScan, age: float = 0.0) -> None:
        """Show one scan and let 0.1 s pass."""
        self.send("/scan", scan, age)
        self.harness.run(SCAN_SECONDS)

    def send(self, topic: str, message: Any, age: float = 0.0) -> None:
        """Publish a message; a header's stamp is `age` seconds old when it comes."""
        if self._stands_in and topic == "/scan":
            self.send("/clearance", right_clearance(self.types.clearance, message), age)
            return
        if hasattr(message, "header"):
            stamp = self.harness.next_ns - round(age * 1e9)
            message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, 10**9)
        self.harness.publish(topic, message)

    def wait(self, seconds: float) -> Received:
        """Show nothing for a while; return what was said in that time."""
        began = self.seconds
        self.harness.run(seconds)
        return self.messages(began)

    def messages(self, since: float, until: float = math.inf) -> Received:
        """Return what was said after `since`, in seconds of ROS time, and up to `until`."""
        topics = ("/clearance", "/cmd_vel", "/health")
        return Received(*(tuple(self.harness.messages(topic, since=since, until=until)) for topic in topics))


class SharedSystem:
    """Keeps one system for several checks, and starts it anew once one of its programs has ended.

    Args:
        workspace: where the programs are installed.
        clock_rate, absent, stands_in: as of `System`.
    """

    def __init__(
        self,
        workspace: Workspace,
        clock_rate: float = 1.0,
        absent: Collection[str] = (),
        *,
        stands_in: bool = False,
    ) -> None:
        self._workspace, self._clock_rate, self._absent, self._stands_in = workspace, clock_rate, absent, stands_in
        self._needed: tuple[str, ...] = ()
        self._shared = Shared(self._make, lambda system: system.serves(self._needed))

    def get(self, *needed: str) -> System:
        """Return a system in which these programs run; that others fail is no matter then."""
        self._needed = needed
        system = self._shared.get()
        system.need(needed)
        return system

    def close(self) -> None:
        """End the present system; the next check gets a new one."""
        self._shared.close()

    def _make(self) -> System:
        kinds = types(load_messages(self._workspace))
        return System(self._workspace, kinds, self._needed, self._clock_rate, self._absent, stands_in=self._stands_in)


def expect_still(commands: Sequence[ReceivedMessage], situation: str, *, fraction: float = 0.0) -> None:
    """Fail the check unless every command is zero."""
    expect(bool(commands), f"{situation}, no command came on cmd_vel: the robot should be told to stand still.")
    bad = next((c for c in commands if not _stands(c)), None)
    did = "" if bad is None else describe_command(bad.message)
    expect(bad is None, f"{situation}, the robot {did}: it should stand still.", fraction=fraction)


def expect_driving(
    commands: Sequence[ReceivedMessage],
    situation: str,
    fastest: float,
    *,
    fraction: float = 0.0,
    always: bool = False,
) -> None:
    """Fail the check unless the commands drive forward, at most at `fastest` m/s.

    Who stands still now and then has an error that few checks see, which ask whether it drives `always`.
    """
    expect(bool(commands), f"{situation}, no command came on cmd_vel: the robot should drive.")
    bad = next((c for c in _judged(commands, always) if not 0.0 < c.message.linear.x <= fastest + TOLERANCE), None)
    did = "" if bad is None else describe_command(bad.message)
    expect(
        bad is None,
        f"{situation}, the robot {did}: it should drive forward, at most at {fastest:.2f} m/s.",
        fraction=fraction,
    )


def expect_turning(
    commands: Sequence[ReceivedMessage], situation: str, side: str, fastest: float, *, fraction: float = 0.0
) -> None:
    """Fail the check unless the commands turn on the spot to a side, at most at `fastest` rad/s.

    As in `expect_driving`, it is no matter here whether the robot stands still now and then.
    """
    expect(bool(commands), f"{situation}, no command came on cmd_vel: the robot should turn.")
    sign = 1.0 if side == "left" else -1.0
    bad = next(
        (
            c
            for c in _judged(commands)
            if not (_near(c.message.linear.x, 0.0) and 0.0 < sign * c.message.angular.z <= fastest + TOLERANCE)
        ),
        None,
    )
    did = "" if bad is None else describe_command(bad.message)
    expect(
        bad is None,
        f"{situation}, the robot {did}: it should turn {side} on the spot, at most at {fastest:.2f} rad/s.",
        fraction=fraction,
    )


def describe_report(report: Any) -> str:
    """Put a report of the monitor into words."""
    level = LEVELS[report.level] if 0 <= report.level < len(LEVELS) else str(report.level)
    silent = ", ".join(str(topic)[:40] for topic in list(report.silent)[:5]) or "none"
    return f"level {level}, silent: {silent}"


def _is_installed(workspace: Workspace, program: str) -> bool:
    return program in installed.look(workspace.install, PACKAGE).executables


def _judged(commands: Sequence[ReceivedMessage], always: bool = False) -> Sequence[ReceivedMessage]:
    """Return the commands to be judged: those that move, or all where none does."""
    return commands if always else [c for c in commands if not _stands(c)] or commands


def _stands(command: ReceivedMessage) -> bool:
    return _near(command.message.linear.x, 0.0) and _near(command.message.angular.z, 0.0)


def _near(value: float, wanted: float) -> bool:
    return abs(value - wanted) <= TOLERANCE  # false for nan
