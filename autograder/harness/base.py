"""What all harnesses have in common: a student's programs, and the grader's node that talks with them over DDS."""

from __future__ import annotations

import itertools
import math
import time
from abc import ABC, abstractmethod
from bisect import bisect_right
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, replace
from operator import attrgetter
from typing import Any, TypeVar

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import DoubtfulError, StudentError
from autograder.harness.goals import Actions, Goal, ReceivedMessage
from autograder.harness.grader_node import NAME, GraderNode, OnMessage
from autograder.harness.message_text import format_message
from autograder.harness.steps import FINEST_TICK_NS, TICK_NS
from autograder.ros.discovery import PROFILES, PROFILES_VARIABLE
from autograder.ros.domains import Domain
from autograder.run.lockstep.failures import diagnose_exit
from autograder.run.sandbox import Mount, Process
from autograder.run.workspace import Workspace
from autograder.submission.reading import record_data

MATCH_SECONDS = 30.0  # maximum real time until all endpoints are matched
NAME_SECONDS = 5.0  # maximum real time until the names of the endpoints' nodes are known

_DOMAIN_OFFSETS = itertools.count()
_SECONDS = attrgetter("seconds")

AnyHarness = TypeVar("AnyHarness", bound="Harness")


@dataclass(frozen=True)
class Program:
    """An executable of a package, and its arguments."""

    package: str
    executable: str
    arguments: tuple[str, ...] = ()


class Harness(ExitStack, ABC):
    """A student's programs and the grader's node that talks with them over DDS; a context manager.

    Name the topics that the grader publishes and subscribes to, then enter the harness::

        sensors, commands = {"/scan": LaserScan}, {"/cmd_vel": Twist}
        with SteppedHarness(workspace, PACKAGE, EXECUTABLE, publishes=sensors, subscribes=commands) as harness:
            harness.publish("/scan", scan)
            harness.run(0.1)
            harness.messages("/cmd_vel")

    Every method raises `StudentError` when a program crashes, hangs or exceeds a limit.

    Args:
        workspace: the student's built workspace.
        package: the package of the program.
        executable: the name of the program in the package.
        programs: several programs instead of one. They can also communicate with each other.
        publishes: topics that the grader publishes, with their types.
        subscribes: topics that the grader subscribes to, with their types.
        arguments: the arguments of the program `executable`.
        clock_rate: how many seconds the programs' system clock advances per second of ROS time; always 1 in real time.

    Attributes:
        node: the grader's node; its graph functions show the actual endpoints of the student's programs.
        tick_ns: the length of a step of ROS time. It depends on the programs' timers.
        finest_tick_ns: the length of the shortest step.
        optional: executables that may fail. The others continue without them.
        discovery_seconds: the time from the discovery of the nodes to that of their endpoints; 0 in lockstep.
    """

    tick_ns = TICK_NS
    finest_tick_ns = FINEST_TICK_NS
    optional: frozenset[str] = frozenset()
    discovery_seconds = 0.0

    def __init__(
        self,
        workspace: Workspace,
        package: str = "",
        executable: str = "",
        *,
        programs: tuple[Program, ...] = (),
        publishes: Mapping[str, type] | None = None,
        subscribes: Mapping[str, type] | None = None,
        arguments: tuple[str, ...] = (),
        clock_rate: float = 1.0,
    ) -> None:
        super().__init__()
        self._clock_rate = clock_rate
        self.programs = programs or (Program(package, executable, arguments),)
        self._paths = [workspace.executable(program.package, program.executable) for program in self.programs]
        # Each harness has its own ROS domain, because two open harnesses may run programs with the same names.
        self._domain = Domain(workspace.domain + next(_DOMAIN_OFFSETS))
        self._workspace = replace(workspace, domain=self._domain.number)
        sandbox = self._workspace.sandbox()
        # The profiles make programs discover each other at once.
        environment = {**sandbox.environment, PROFILES_VARIABLE: str(PROFILES)}
        self._sandbox = replace(sandbox, mounts=(*sandbox.mounts, Mount(PROFILES)), environment=environment)
        self._publishes, self._subscribes = dict(publishes or {}), dict(subscribes or {})
        self._received: dict[str, list[ReceivedMessage]] = {topic: [] for topic in self._subscribes}

    # Defined by each kind of harness.

    @property
    @abstractmethod
    def processes(self) -> tuple[Process, ...]:
        """The sandboxed programs."""

    @property
    @abstractmethod
    def running(self) -> frozenset[str]:
        """The executables that the harness has not dropped."""

    @property
    @abstractmethod
    def now_ns(self) -> int:
        """ROS time in nanoseconds, as the program sees it."""

    @property
    @abstractmethod
    def seconds(self) -> float:
        """Seconds of ROS time since the program started."""

    @abstractmethod
    def step(self, dt_ns: int) -> None:
        """Let the programs run for the next `dt_ns` nanoseconds of ROS time."""

    @abstractmethod
    def until(self, condition: Callable[[], bool], seconds: float) -> bool:
        """Let the programs run until `condition` is true, at most `seconds` of ROS time. Return whether it is."""

    @abstractmethod
    def _start(self) -> None:
        """Start the programs and wait until they are up."""

    @abstractmethod
    def _topics(self) -> tuple[set[str], set[str]]:
        """Return the topics of `publishes` that programs subscribe to, and those of `subscribes` that they publish."""

    @abstractmethod
    def _connected(self) -> bool:
        """Return whether all endpoints are matched."""

    # Common to all kinds.

    def __enter__(self: AnyHarness) -> AnyHarness:
        self.callback(self._domain.close)
        self._grader_node = GraderNode(self._domain.number, self._log_exchange)
        self.callback(self._grader_node.close)
        self._actions = Actions(self._grader_node, self._arrival_seconds)
        self.node = self._grader_node.node
        record_data("The ROS graph of your program")
        try:
            self._start()
            self._match()
        except BaseException:
            self.close()
            raise
        return self

    @property
    def output(self) -> str:
        """The output of the programs so far, including their logs."""
        record_data("The output of your program")
        return "".join(process.output for process in self.processes)

    def require_running(self) -> None:
        """Raise the StudentError of the first program that has ended."""
        for process in self.processes:
            if process.exit_reason is not None:
                raise StudentError(diagnose_exit(process))

    def takes(self, topic: str) -> bool:
        """Return whether the grader publishes a topic, and a program subscribes to it with the same type."""
        return topic in self._grader_node.publishers

    def publish(self, topic: str, message: Any) -> None:
        """Publish a message. Nothing happens if no program subscribes to the topic."""
        if self.takes(topic):
            self._grader_node.publish(topic, message)

    def run(self, seconds: float) -> None:
        """Let the programs run for `seconds` of ROS time, tick by tick."""
        remaining_ns = round(seconds * 1e9)
        while remaining_ns > 0:
            self.step(min(self.tick_ns, remaining_ns))
            remaining_ns -= self.tick_ns

    def subscribe(self, topics: Mapping[str, type]) -> None:
        """Subscribe to more topics while the programs run. `topics` contains their types by name."""
        self._subscribes.update(topics)
        for topic in topics:
            self._received.setdefault(topic, [])
        self._match()

    def messages(self, topic: str, *, since: float = -math.inf, until: float = math.inf) -> list[ReceivedMessage]:
        """Return the messages that arrived on a topic after `since` and not after `until`, in s since the start."""
        record_data(f"The messages of your program on {topic}")
        received = self._received[topic]
        first = bisect_right(received, since, key=_SECONDS)
        return received[first : bisect_right(received, until, first, key=_SECONDS)]

    def rate(self, topic: str, since: float) -> float:
        """Return the number of messages per second of ROS time on `topic` between `since` and now."""
        return len(self.messages(topic, since=since)) / (self.seconds - since)

    def call(self, service_type: Any, name: str, request: Any, seconds: float = 5.0) -> Any:
        """Call a service of the student's programs, and let the programs run meanwhile.

        Returns:
            The response, or None if no such service answers within `seconds` of ROS time.
        """
        record_data(f"The answer of {name}")
        answers: list[Any] = []
        start = self.seconds
        client = self._grader_node.client(service_type, name)
        if client is not None and self._wait_for_server(client, seconds):
            self._grader_node.ask(service_type, name, request, answers.append)
            if self.until(lambda: bool(answers), start + seconds - self.seconds):
                return answers[0]
        self._workspace.exchanges.add(self.seconds, "no answer", name, f"within {seconds:g} s")
        return None

    def send_goal(self, action_type: Any, name: str, goal: Any, seconds: float = 5.0) -> Goal:
        """Send a goal to a student's action server. The goal makes progress while the programs run.

        The goal's `accepted` stays None if no server appears within `seconds` of ROS time.
        """
        record_data(f"The answer of {name}")
        clients = self._actions.prepare(action_type, name)
        if not all(client is not None and self._wait_for_server(client, seconds) for client in clients):
            return Goal()
        return self._actions.send(action_type, name, goal)

    def wait_for(self, condition: Callable[[], bool], seconds: float) -> bool:
        """Take messages until `condition` is true, at most `seconds` of real time. Return whether it is."""
        deadline = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > deadline:
                return False
            self._grader_node.spin(0.005)
        return True

    def nodes(self) -> list[str]:
        """Return the fully qualified names of the student's nodes that are visible now."""
        return self._grader_node.other_nodes()

    @abstractmethod
    def _wait_for_server(self, client: Any, seconds: float) -> bool:
        """Wait at most `seconds` of ROS time until a client is matched with its server. Return whether it is."""

    def _match(self) -> None:
        """Create the grader's endpoints that correspond to the programs', and wait until all are matched."""
        subscribed_topics, published_topics = self._topics()
        for topic in sorted(subscribed_topics):
            self._grader_node.make_publisher(topic, self._publishes[topic])
        for topic in sorted(published_topics):
            self._grader_node.make_subscription(topic, self._subscribes[topic], self._receiver(topic))
        self._await(self._connected)
        # An endpoint is discovered before its node. An endpoint that rclpy did not create has no node.
        self.wait_for(lambda: self._grader_node.knows_nodes_of(subscribed_topics | published_topics), NAME_SECONDS)

    def _receiver(self, topic: str) -> OnMessage:
        received = self._received[topic]
        return lambda message, arrived_ns: received.append(ReceivedMessage(self._arrival_seconds(arrived_ns), message))

    def _log_exchange(self, kind: str, name: str, message: Any) -> None:
        self._workspace.exchanges.add(self.seconds, kind, name, format_message(message))

    def _arrival_seconds(self, arrived_ns: int) -> float:
        """Return the ROS time, in s since the start, at which a message arrived. `arrived_ns` counts from the epoch."""
        return self.seconds

    def _error_of(self, program: Program, error: StudentError) -> StudentError:
        """Return a program's error. If several programs are running, add the program's name."""
        if len(self.processes) == 1:
            return error
        return StudentError(replace(error.diagnosis, sentence=f"{program.executable}: {error.diagnosis.sentence}"))

    def _await(self, condition: Callable[[], bool]) -> None:
        is_matched = self.wait_for(lambda: self._grader_node.is_impersonated() or condition(), MATCH_SECONDS)
        if self._grader_node.is_impersonated():
            sentence = f"Your node is called {NAME}, which is the grader's own name: give it the required name."
            raise StudentError(Diagnosis(Kind.RESERVED_NAME, sentence))
        if not is_matched:
            sentence = (
                f"Your node and the grader did not discover each other within {MATCH_SECONDS:.0f} s: create "
                "your publishers, subscriptions and services with rclpy, and store them in attributes of the node."
            )
            raise DoubtfulError(Diagnosis(Kind.STUCK, sentence))
