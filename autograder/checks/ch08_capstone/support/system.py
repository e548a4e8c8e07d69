"""Runs the student's three programs, publishes scans to them, and collects the messages that they publish."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator
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
)
from autograder.checking.probes import installed, parameters
from autograder.checks.ch08_capstone.support.clearances import expected_clearance
from autograder.checks.ch08_capstone.support.contract import CONTROLLER, PACKAGE, PROCESSOR, PROGRAMS, name_of
from autograder.checks.ch08_capstone.support.messages import MessageTypes, load_messages, message_types

SETTLING_SECONDS = 0.35  # s in which a scan passes through both nodes and a command at 10 Hz follows
ANSWER_SECONDS = 5.0  # s of ROS time for the response of a service
NO_SCAN_SECONDS = 1.6  # s at the start without a scan, enough for three reports


@dataclass(frozen=True)
class SystemMessages:
    """The messages that the system published in an interval, in the order of their arrival."""

    clearances: tuple[ReceivedMessage, ...]
    commands: tuple[ReceivedMessage, ...]
    reports: tuple[ReceivedMessage, ...]


class System:
    """The three programs in one harness.

    In lockstep, a scan, its clearance and the command that follows belong to one step.

    Args:
        workspace: the workspace in which they are installed.
        types: the types of the student's messages.
        needed_programs: programs that have to run; the others may be missing, or fail.
        clock_rate: how many seconds the machine's clocks advance in a second of ROS time; always 1 in real time.
        absent_programs: programs that are not started; checks can send the messages that these would publish.
        sends_clearances: whether the expected clearance of each scan is sent if sensor_processor is absent.

    Attributes:
        harness: the harness in which they run.
        types: the types of the student's messages.
        before_first_scan: the messages that the programs published before the first scan.
    """

    def __init__(
        self,
        workspace: Workspace,
        types: MessageTypes,
        needed_programs: Collection[str] = PROGRAMS,
        clock_rate: float = 1.0,
        absent_programs: Collection[str] = (),
        *,
        sends_clearances: bool = False,
    ) -> None:
        self.types, self._sends_clearances = types, sends_clearances and PROCESSOR in absent_programs
        outputs = {PROCESSOR: ("/clearance", types.clearance), CONTROLLER: ("/cmd_vel", Twist)}
        started_programs = [
            name
            for name in PROGRAMS
            if name not in absent_programs and (name in needed_programs or _is_installed(workspace, name))
        ]
        self.harness = AutoHarness(
            workspace,
            programs=tuple(Program(PACKAGE, name) for name in started_programs),
            publishes={"/scan": LaserScan, **dict(outputs[name] for name in outputs if name in absent_programs)},
            subscribes={"/clearance": types.clearance, "/cmd_vel": Twist, "/health": types.health},
            clock_rate=clock_rate,
        )
        self.require(needed_programs)

    def __enter__(self) -> System:
        self.harness.__enter__()
        try:
            self.before_first_scan = self.wait(NO_SCAN_SECONDS)
        except BaseException:
            self.harness.__exit__(None, None, None)
            raise
        return self

    def __exit__(self, *exc_info: object) -> None:
        self.harness.__exit__(None, None, None)

    def require(self, needed_programs: Collection[str]) -> None:
        """Set the programs that have to run from now on; the others may fail."""
        self.harness.optional = frozenset(PROGRAMS) - frozenset(needed_programs)

    def runs(self, programs: Collection[str]) -> bool:
        """Return whether all these programs are running."""
        return self.harness.running.issuperset(programs)

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
    def changed_parameter(self, program: str, name: str, value: float) -> Iterator[parameters.SetParametersReply]:
        """Change a parameter within a `with` block; yield the program's reply."""
        node_parameters = self.parameters_of(program)
        original_values = node_parameters.values(name)
        reply = (
            node_parameters.change({name: value}) if original_values else parameters.SetParametersReply(accepted=False)
        )
        try:
            yield reply
        finally:
            if reply.accepted:
                node_parameters.change(original_values)  # another check tests whether this is the contract's default

    def publish_scans(self, scan: LaserScan, seconds: float = 0.7, *, age: float = 0.0) -> SystemMessages:
        """Publish a scan ten times a second; return the messages after the programs' reaction time.

        Args:
            scan: the scan; each copy gets its own stamp.
            seconds: how long the scan is published.
            age: the age of the stamps when the scans arrive, in seconds.
        """
        start = self.seconds
        for _ in range(round(seconds / SCAN_SECONDS)):
            self.publish_scan(scan, age)
        return self.messages(start + SETTLING_SECONDS)

    def publish_scan(self, scan: LaserScan, age: float = 0.0) -> None:
        """Publish one scan and let 0.1 s pass."""
        self.send("/scan", scan, age)
        self.harness.run(SCAN_SECONDS)

    def send(self, topic: str, message: Any, age: float = 0.0) -> None:
        """Publish a message; the stamp of a header is `age` seconds old when the message arrives."""
        if self._sends_clearances and topic == "/scan":
            self.send("/clearance", expected_clearance(self.types.clearance, message), age)
            return
        if hasattr(message, "header"):
            stamp = self.harness.next_ns - round(age * 1e9)
            message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, 10**9)
        self.harness.publish(topic, message)

    def wait(self, seconds: float) -> SystemMessages:
        """Publish nothing for a while; return the messages that the programs publish meanwhile."""
        start = self.seconds
        self.harness.run(seconds)
        return self.messages(start)

    def messages(self, since: float, until: float = math.inf) -> SystemMessages:
        """Return the messages after `since`, in seconds of ROS time, and up to `until`."""
        topics = ("/clearance", "/cmd_vel", "/health")
        return SystemMessages(*(tuple(self.harness.messages(topic, since=since, until=until)) for topic in topics))


class SharedSystem:
    """Keeps one system for several checks, and restarts it when one of its programs has ended.

    Args:
        workspace: the workspace in which the programs are installed.
        clock_rate, absent_programs, sends_clearances: see `System`.
    """

    def __init__(
        self,
        workspace: Workspace,
        clock_rate: float = 1.0,
        absent_programs: Collection[str] = (),
        *,
        sends_clearances: bool = False,
    ) -> None:
        self._workspace, self._clock_rate, self._absent_programs, self._sends_clearances = (
            workspace,
            clock_rate,
            absent_programs,
            sends_clearances,
        )
        self._needed_programs: tuple[str, ...] = ()
        self._shared = Shared(self._start_system, lambda system: system.runs(self._needed_programs))

    def get(self, *needed_programs: str) -> System:
        """Return a system in which these programs run; the others may fail."""
        self._needed_programs = needed_programs
        system = self._shared.get()
        system.require(needed_programs)
        return system

    def close(self) -> None:
        """End the current system; the next check gets a new one."""
        self._shared.close()

    def _start_system(self) -> System:
        types = message_types(load_messages(self._workspace))
        return System(
            self._workspace,
            types,
            self._needed_programs,
            self._clock_rate,
            self._absent_programs,
            sends_clearances=self._sends_clearances,
        )


def _is_installed(workspace: Workspace, program: str) -> bool:
    return program in installed.inspect_package(workspace.install, PACKAGE).executables
