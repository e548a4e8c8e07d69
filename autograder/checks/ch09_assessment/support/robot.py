"""Harnesses for the student's three nodes, which send and receive each node's messages."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from autograder.checking import (
    LOCKSTEP,
    OK,
    AutoHarness,
    CheckFailed,
    Diagnosis,
    Kind,
    ReceivedMessage,
    StudentError,
    Workspace,
    expect,
    explain,
    find_packages,
    load_interfaces,
    nearest,
)
from autograder.checking.probes import parameters
from autograder.checks.ch09_assessment.support.contract import (
    GUARD,
    INTERFACES,
    PACKAGE,
    PERIOD,
    SMOOTHER,
    THERMOMETER,
    TOLERANCE,
    reading,
)

FIELDS = {"Temperature": ("stamp", "celsius"), "Decision": ("stamp", "cooling", "celsius")}
MESSAGE_SECONDS = 0.1  # s between two messages
NANOSECONDS = 250_000_000  # the nanoseconds of each stamp, in addition to its seconds
HEAD_START = 0.2  # s that a node in real time may run before it is discovered
# For each node, the topics that it subscribes to and those that it publishes, with their message types.
_TOPICS = {
    THERMOMETER: ({}, {"/temperature": "Temperature"}),
    SMOOTHER: ({"/temperature": "Temperature"}, {"/smoothed": "Temperature"}),
    GUARD: ({"/smoothed": "Temperature"}, {"/decision": "Decision"}),
}


@dataclass(frozen=True)
class Types:
    """Classes for the student's messages, which hold plain values."""

    temperature: Any
    decision: Any

    @classmethod
    def load(cls, workspace: Workspace) -> Types:
        """Read the message types of a workspace.

        Raises:
            CheckFailed: a field is missing. Other errors are those of `load_interfaces`.
        """
        package = load_interfaces(workspace, INTERFACES)
        for name, fields in FIELDS.items():
            message = getattr(package.msg, name, None)
            field_names = message.get_fields_and_field_types() if message is not None else {}
            missing_fields = [field for field in fields if field not in field_names]
            expect(
                not missing_fields,
                f"{name}.msg has no {' and no '.join(missing_fields)}: the grader cannot use this message.",
            )
        return cls(package.msg.Temperature, package.msg.Decision)


class NodeHarness(AutoHarness):
    """The harness of one of the three nodes, which starts with the given parameters.

    If `is_subscribed` is False, nothing subscribes to the node's output before `subscribe_late`.
    """

    def __init__(
        self,
        workspace: Workspace,
        types: Types,
        name: str,
        *,
        clock_rate: float = 1.0,
        is_subscribed: bool = True,
        **values: float,
    ) -> None:
        by_name = {"Temperature": types.temperature, "Decision": types.decision}
        inputs, outputs = ({topic: by_name[kind] for topic, kind in topics.items()} for topics in _TOPICS[name])
        arguments = ("--ros-args", *parameters.override_arguments(values))
        subscribes = outputs if is_subscribed else {}
        super().__init__(
            workspace,
            PACKAGE,
            name,
            publishes=inputs,
            subscribes=subscribes,
            arguments=arguments,
            clock_rate=clock_rate,
        )
        self._types, self._name, self._outputs = types, name, outputs
        self._output, self._input = next(iter(outputs)), next(iter(inputs), "")

    def subscribe_late(self) -> None:
        """Subscribe to the node's output, if the harness was created with `is_subscribed` False."""
        self.subscribe(self._outputs)

    def published(self, since: float = -1.0) -> list[ReceivedMessage]:
        """Return the messages that the node has published."""
        return self.messages(self._output, since=since)

    def send(
        self,
        temperatures: Iterable[float],
        first: int = 1,
        *,
        apart: float = MESSAGE_SECONDS,
        nanoseconds: int = NANOSECONDS,
    ) -> list[Any]:
        """Send temperatures, and return the messages that the node publishes in reply.

        Args:
            temperatures: the temperatures in degrees Celsius.
            first: the seconds of the first stamp; each further stamp is a second later.
            apart: the ROS time between two messages in s, at most `MESSAGE_SECONDS`. 0 sends all at once.
            nanoseconds: the nanoseconds of each stamp.
        """
        start, values = self.seconds, list(temperatures)
        for second, celsius in enumerate(values, first):
            message = self._types.temperature(celsius=float(celsius))
            message.stamp.sec, message.stamp.nanosec = second, nanoseconds
            self.publish(self._input, message)
            self.run(apart)
        self.run(MESSAGE_SECONDS - apart)
        self.wait_for_late(lambda: len(self.published(start)) >= len(values))
        return [received.message for received in self.published(start)]

    def expect_readings(
        self, count: int, period: float = PERIOD, *shape: float, reading: Callable[..., float] = reading
    ) -> None:
        """Fail the check unless the first readings and their rate follow the contract.

        Args:
            count: the number of readings.
            period: the expected period in s.
            shape: mean and swing in degrees Celsius; empty for the defaults.
            reading: a formula other than the contract's, for checks that do not test the formula.
        """
        start, seconds = self.seconds, (count + 0.5) * period
        self.run(seconds)
        actual = [received.message.celsius for received in self.published()]
        expect(bool(actual), f"In {seconds:.1f} s, it published nothing.")
        for number, celsius in enumerate(actual, self._count_missed(actual, period, shape, reading)):
            expected = reading(number, *shape)
            if not near(celsius, expected):
                raise CheckFailed(f"Reading number {number} was {celsius:.2f} °C instead of {expected:.2f} °C.")
        published_count = round(self.rate(self._output, start) * seconds)
        expect(
            abs(published_count - count) <= 1,
            f"In {seconds:.1f} s, it published {published_count} readings instead of {count}.",
            fraction=0.5,
        )

    def _count_missed(
        self, actual: list[float], period: float, shape: tuple[float, ...], reading: Callable[..., float]
    ) -> int:
        """Return the number of readings before the grader subscribed, which is 0 in lockstep."""
        max_missed = 0 if self.time == LOCKSTEP else int((2 * self.discovery_seconds + HEAD_START) / period)
        candidates = range(max_missed + 1)
        fits = (i for i in candidates if all(near(x, reading(j, *shape)) for j, x in enumerate(actual[:2], i)))
        return next(fits, 0)

    def try_to_set(self, **values: parameters.Value) -> None:
        """Try to change the node's parameters. The node may refuse, or have no parameter services."""
        with suppress(CheckFailed):
            parameters.NodeParameters(self, f"/{self._name}").change(values)

    def expect_in_graph(self) -> None:
        """Fail the check unless the node has the correct name, and the correct topics and types."""
        nodes = self.nodes()
        message = f"The node is called {', '.join(nodes)} instead of /{self._name}."
        expect(f"/{self._name}" in nodes, message, fraction=0.5)
        publishes = dict(self.node.get_publisher_names_and_types_by_node(self._name, "/"))
        subscribes = dict(self.node.get_subscriber_names_and_types_by_node(self._name, "/"))
        inputs, outputs = _TOPICS[self._name]
        _expect_topics(self._name, "publishes", publishes, outputs)
        _expect_topics(self._name, "subscribes to", subscribes, inputs)


Start = Callable[..., NodeHarness]  # takes a node's name and its parameters


def near(one: float, other: float) -> bool:
    """Return whether two temperatures are equal within the tolerance."""
    return abs(one - other) <= TOLERANCE


def _expect_topics(node: str, verb: str, actual: Mapping[str, list[str]], expected: Mapping[str, str]) -> None:
    for topic, kind in expected.items():
        full_type = f"{INTERFACES}/msg/{kind}"
        similar = nearest(topic, actual, 0.5)
        instead = f"It {verb} {similar} instead." if similar else "It has no similar topic."
        expect(topic in actual, f"{node} should have the topic {topic[1:]}. {instead}")
        expect(
            actual[topic] == [full_type],
            f"{node} {verb} {topic} as {', '.join(actual[topic])} instead of {full_type}.",
        )


def refuses(workspace: Workspace, types: Types, name: str, **values: float) -> bool:
    """Return whether a node does not start with these parameters.

    Raises:
        CheckFailed: the node ended without an exception and with exit status 0.
    """
    try:
        with NodeHarness(workspace, types, name, is_subscribed=True, **values):
            return False
    except StudentError as error:
        if error.diagnosis.kind not in (Kind.CRASHED_AT_START, Kind.ENDED_EARLY):
            raise
        is_silent = error.diagnosis.kind is Kind.ENDED_EARLY and "(exit status 0)" in error.diagnosis.sentence
        values_text = ", ".join(f"{parameter} {value}" for parameter, value in values.items())
        observation = f"Started with {values_text}, {name} ended with exit status 0"
        expect(not is_silent, f"{observation}. A node that ends with an error has another exit status.", fraction=0.75)
        return True


def require_built(builds: Mapping[str, Diagnosis], package: str) -> None:
    """Fail the check, with the diagnosis of the build, unless a package was built."""
    if builds[package] is not OK:
        raise CheckFailed(f"{package} was not built: {builds[package].sentence}")


def source_of(workspace: Workspace, package: str) -> Path:
    """Return the folder of a package's source.

    Raises:
        CheckFailed: there is no such package.
    """
    source = workspace.root / "src"
    folders, broken = find_packages(source)
    if package not in folders:
        sentence = broken.get(source / package, f"There is no package {package} in ws/src.")
        raise CheckFailed(explain(Diagnosis(Kind.MISSING_PACKAGE, sentence), source, package).sentence)
    return folders[package]


def expect_executables(installed: Iterable[str], misplaced: Iterable[str], expected: Iterable[str]) -> None:
    """Fail the check unless all programs are installed where `ros2 run` finds them."""
    names = set(installed)
    absent = ", ".join(name for name in expected if name not in names)
    if absent and list(misplaced):
        raise CheckFailed(f"{absent} was installed in bin/, where ros2 run does not look: set the folder in setup.cfg.")
    message = f"Programs that are not installed: {absent}. Installed programs: {', '.join(sorted(names)) or 'none'}."
    expect(not absent, message, fraction=0.5 if names else 0.0)
