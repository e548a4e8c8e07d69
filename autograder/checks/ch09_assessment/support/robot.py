"""The student's three nodes in harnesses of their own, each between messages that the grader sends and hears."""

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
STEP = 0.1  # s between two messages
NANOSECONDS = 250_000_000  # of each stamp, beside its seconds
HEAD_START = 0.2  # s for which a node in real time may be up before it is seen
_TOPICS = {
    THERMOMETER: ({}, {"/temperature": "Temperature"}),
    SMOOTHER: ({"/temperature": "Temperature"}, {"/smoothed": "Temperature"}),
    GUARD: ({"/smoothed": "Temperature"}, {"/decision": "Decision"}),
}


@dataclass(frozen=True)
class Types:
    """The student's messages, as classes of plain values."""

    temperature: Any
    decision: Any

    @classmethod
    def of(cls, workspace: Workspace) -> Types:
        """Read them. Raises as `load_interfaces` does, and a CheckFailed where a field is missing."""
        package = load_interfaces(workspace, INTERFACES)
        for name, fields in FIELDS.items():
            message = getattr(package.msg, name, None)
            there = message.get_fields_and_field_types() if message is not None else {}
            absent = [field for field in fields if field not in there]
            expect(not absent, f"{name}.msg has no {' and no '.join(absent)}: nobody can talk to the nodes.")
        return cls(package.msg.Temperature, package.msg.Decision)


class NodeHarness(AutoHarness):
    """The harness of one of the three nodes, started with parameters of the check's choice.

    Where `is_heard` is False, nobody subscribes to what the node publishes before `listen_late`.
    """

    def __init__(
        self,
        workspace: Workspace,
        types: Types,
        name: str,
        *,
        clock_rate: float = 1.0,
        is_heard: bool = True,
        **values: float,
    ) -> None:
        by_name = {"Temperature": types.temperature, "Decision": types.decision}
        takes, publishes = ({t: by_name[kind] for t, kind in topics.items()} for topics in _TOPICS[name])
        arguments = ("--ros-args", *parameters.override_arguments(values))
        heard = publishes if is_heard else {}
        super().__init__(
            workspace, PACKAGE, name, publishes=takes, subscribes=heard, arguments=arguments, clock_rate=clock_rate
        )
        self._types, self._name, self._outputs = types, name, publishes
        self._out, self._in = next(iter(publishes)), next(iter(takes), "")

    def listen_late(self) -> None:
        """Subscribe to what the node publishes, to which nobody has listened so far."""
        self.subscribe(self._outputs)

    def published(self, since: float = -1.0) -> list[ReceivedMessage]:
        """Return what it has published."""
        return self.messages(self._out, since=since)

    def send(
        self, temperatures: Iterable[float], first: int = 1, *, apart: float = STEP, nanoseconds: int = NANOSECONDS
    ) -> list[Any]:
        """Send temperatures, stamped `nanoseconds` after the seconds `first`, `first` + 1, ...; return what came.

        They are sent `apart` seconds of ROS time apart, `STEP` at most. 0 sends them all at once.
        """
        began, sent = self.seconds, list(temperatures)
        for second, celsius in enumerate(sent, first):
            message = self._types.temperature(celsius=float(celsius))
            message.stamp.sec, message.stamp.nanosec = second, nanoseconds
            self.publish(self._in, message)
            self.run(apart)
        self.run(STEP - apart)
        self.wait_for_late(lambda: len(self.published(began)) >= len(sent))
        return [received.message for received in self.published(began)]

    def expect_readings(
        self, count: int, period: float = PERIOD, *shape: float, reading: Callable[..., float] = reading
    ) -> None:
        """Fail the check unless the first readings are those of the contract, in their time; `shape` is mean, swing.

        Another `reading` than the contract's stands for its formula where that is not judged.
        """
        began, seconds = self.seconds, (count + 0.5) * period
        self.run(seconds)
        seen = [received.message.celsius for received in self.published()]
        expect(bool(seen), f"In {seconds:.1f} s it published nothing.")
        for number, celsius in enumerate(seen, self._missed(seen, period, shape, reading)):
            wanted = reading(number, *shape)
            if not near(celsius, wanted):
                raise CheckFailed(f"Reading number {number} was {celsius:.2f} °C, it should have been {wanted:.2f} °C.")
        published = round(self.rate(self._out, began) * seconds)
        right = abs(published - count) <= 1
        expect(right, f"In {seconds:.1f} s it published {published} readings, instead of {count}.", fraction=0.5)

    def _missed(self, seen: list[float], period: float, shape: tuple[float, ...], reading: Callable[..., float]) -> int:
        """Return how many readings were over before the grader listened: in lockstep none."""
        most = 0 if self.time == LOCKSTEP else int((2 * self.discovery_seconds + HEAD_START) / period)
        fits = (n for n in range(most + 1) if all(near(one, reading(m, *shape)) for m, one in enumerate(seen[:2], n)))
        return next(fits, 0)

    def try_to_set(self, **values: parameters.Value) -> None:
        """Ask the node to change parameters. It may refuse, or have no services of parameters."""
        with suppress(CheckFailed):
            parameters.NodeParameters(self, f"/{self._name}").change(values)

    def expect_in_graph(self) -> None:
        """Fail the check unless the node has its name and its topics, with their types; name what it has instead."""
        nodes = self.nodes()
        said = f"The node is called {', '.join(nodes)}, it should be /{self._name}."
        expect(f"/{self._name}" in nodes, said, fraction=0.5)
        publishes = dict(self.node.get_publisher_names_and_types_by_node(self._name, "/"))
        subscribes = dict(self.node.get_subscriber_names_and_types_by_node(self._name, "/"))
        told, heard = _TOPICS[self._name]
        _expect_topics(self._name, "publishes", publishes, heard)
        _expect_topics(self._name, "subscribes to", subscribes, told)


Start = Callable[..., NodeHarness]  # takes a node's name and its parameters


def near(one: float, other: float) -> bool:
    """Return whether two temperatures are the same."""
    return abs(one - other) <= TOLERANCE


def _expect_topics(node: str, verb: str, found: Mapping[str, list[str]], wanted: Mapping[str, str]) -> None:
    for topic, kind in wanted.items():
        full = f"{INTERFACES}/msg/{kind}"
        near = nearest(topic, found, 0.5)
        instead = f", {node} {verb} {near}" if near else ""
        expect(topic in found, f"{node} should have {topic[1:]}{instead or ', and it has nothing like it'}.")
        expect(found[topic] == [full], f"{node} {verb} {topic} as {', '.join(found[topic])}, instead of {full}.")


def refuses(workspace: Workspace, types: Types, name: str, **values: float) -> bool:
    """Return whether a node ends at its start with these parameters, by an exception or by itself.

    Raises:
        CheckFailed: it ended by itself as if there were no error.
    """
    try:
        with NodeHarness(workspace, types, name, is_heard=True, **values):
            return False
    except StudentError as error:
        if error.diagnosis.kind not in (Kind.CRASHED_AT_START, Kind.ENDED_EARLY):
            raise
        silent = error.diagnosis.kind is Kind.ENDED_EARLY and "(exit status 0)" in error.diagnosis.sentence
        shown = ", ".join(f"{parameter} {value}" for parameter, value in values.items())
        said = f"Started with {shown}, {name} ended with exit status 0: one that ends with an error has another status."
        expect(not silent, said, fraction=0.75)
        return True


def require_built(builds: Mapping[str, Diagnosis], package: str) -> None:
    """Fail the check, with what colcon said, unless a package was built."""
    if builds[package] is not OK:
        raise CheckFailed(f"{package} was not built: {builds[package].sentence}")


def source_of(workspace: Workspace, package: str) -> Path:
    """Return the folder of a package's source.

    Raises:
        CheckFailed: there is none.
    """
    source = workspace.root / "src"
    found, broken = find_packages(source)
    if package not in found:
        sentence = broken.get(source / package, f"There is no package {package} in ws/src.")
        raise CheckFailed(explain(Diagnosis(Kind.MISSING_PACKAGE, sentence), source, package).sentence)
    return found[package]


def expect_executables(installed: Iterable[str], misplaced: Iterable[str], wanted: Iterable[str]) -> None:
    """Fail the check unless all programs lie where `ros2 run` looks."""
    there = set(installed)
    absent = ", ".join(name for name in wanted if name not in there)
    if absent and list(misplaced):
        raise CheckFailed(f"{absent} went to bin/, where ros2 run does not look: setup.cfg says where programs go.")
    said = f"The program {absent} is not installed; installed are: {', '.join(sorted(there)) or 'none'}."
    expect(not absent, said, fraction=0.5 if there else 0.0)
