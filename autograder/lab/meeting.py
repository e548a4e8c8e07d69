"""What both kinds of lab share: the grader's own node, and how its endpoints come to match the student's."""

from __future__ import annotations

import itertools
import math
import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace
from types import TracebackType
from typing import Any, TypeVar

import rclpy
from rclpy.context import Context
from rclpy.guard_condition import GuardCondition
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import GraderError, StudentError
from autograder.lab.workspace import Workspace
from autograder.sandbox import Process

MEETING_SECONDS = 30.0  # real time for the two sides to find each other
DEPTH = 1000
NAME = "grader"
DOMAINS = 100  # beyond about that number, DDS ports reach into the ephemeral ones

_LABS = itertools.count()

AnyLab = TypeVar("AnyLab", bound="Lab")


@dataclass(frozen=True)
class Stamped:
    """A message that the student's program published.

    `seconds` is when it arrived, in seconds of ROS time since the program started.
    """

    seconds: float
    message: Any


class Lab(ABC):
    """One student's program and the grader's node that it meets over DDS; a context manager.

    Name what the grader publishes and listens to, then enter:

        with LockstepLab(workspace, "my_robot_package", "robot_controller",
                         offers={"/scan": LaserScan}, listens={"/cmd_vel": Twist}) as lab:
            lab.publish("/scan", scan)
            lab.run(0.1)
            lab.messages("/cmd_vel")

    `StudentError` comes out of every method when the program crashes, hangs or goes over a limit.

    Attributes:
        node: the grader's node; its graph functions tell what the student's program really offers.
        tick_ns: the step of ROS time that suits the program's timers.
    """

    tick_ns = 100_000_000

    def __init__(
        self,
        workspace: Workspace,
        package: str,
        executable: str,
        *,
        offers: dict[str, type] | None = None,
        listens: dict[str, type] | None = None,
        arguments: tuple[str, ...] = (),
    ) -> None:
        self._program = workspace.executable(package, executable)
        self._arguments = arguments
        # Two labs may be open at once, with programs that have the same names: each pair meets in a domain of its own.
        workspace = replace(workspace, domain=(workspace.domain + next(_LABS)) % DOMAINS)
        self._sandbox = workspace.sandbox()
        self._offers, self._listens = offers or {}, listens or {}
        self._domain = workspace.domain
        self._publishers: dict[str, Any] = {}
        self._received: dict[str, list[Stamped]] = {topic: [] for topic in self._listens}

    # What a kind of lab has to know.

    @property
    @abstractmethod
    def process(self) -> Process:
        """The sandboxed program."""

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
        """Let the program live through the next `dt_ns` nanoseconds of ROS time."""

    @abstractmethod
    def _start(self) -> None:
        """Start the program and wait until it is up."""

    @abstractmethod
    def _topics(self) -> set[str]:
        """Return which topics of this lab the program has; the grader's endpoints are not made yet."""

    @abstractmethod
    def _connected(self, topics: set[str]) -> bool:
        """Return whether the program's endpoints on `topics` see the grader's."""

    # What they share.

    def __enter__(self: AnyLab) -> AnyLab:
        self._context = Context()
        rclpy.init(args=[], context=self._context, domain_id=self._domain)
        self.node = Node(NAME, context=self._context, enable_rosout=False, start_parameter_services=False)
        self._bell = GuardCondition(callback=None, callback_group=None, context=self._context)
        self._inbox: list[tuple[Any, Callable[[Any], None]]] = []
        try:
            self._start()
            self._meet()
        except BaseException:
            self.__exit__(None, None, None)
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.node.destroy_node()
        self._context.try_shutdown()

    @property
    def output(self) -> str:
        """What the program has printed and logged so far."""
        return self.process.output

    def takes(self, topic: str) -> bool:
        """Return whether the program subscribes to a topic that the grader offers, with the right type."""
        return topic in self._publishers

    def publish(self, topic: str, message: Any) -> None:
        """Publish a message. Nothing happens if the program does not subscribe to the topic."""
        if topic in self._publishers:
            self._publishers[topic].publish(message)

    def run(self, seconds: float) -> None:
        """Let the program live through `seconds` of ROS time, tick by tick."""
        left = round(seconds * 1e9)
        while left > 0:
            self.step(min(self.tick_ns, left))
            left -= self.tick_ns

    def messages(self, topic: str, *, since: float = -math.inf, until: float = math.inf) -> list[Stamped]:
        """Return what the program published on `topic` after `since` and up to `until`, in seconds of ROS time."""
        return [stamped for stamped in self._received[topic] if since < stamped.seconds <= until]

    def wait_for(self, condition: Callable[[], bool], seconds: float) -> bool:
        """Listen until `condition` holds, at most `seconds` of real time; return whether it does."""
        deadline = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > deadline:
                return False
            self._spin(0.005)
        return True

    def nodes(self) -> list[str]:
        """Return the fully qualified names of the student's nodes that are seen now."""
        found = self.node.get_node_names_and_namespaces()
        return sorted(f"{space.rstrip('/')}/{name}" for name, space in found if name != NAME)

    def _meet(self) -> None:
        """Make endpoints that match the program's own, and wait until both sides see each other."""
        topics = self._topics()
        offered = {topic for topic in topics & set(self._offers) if self._same_type(topic, self._offers[topic])}
        listened = {topic for topic in topics & set(self._listens) if self._same_type(topic, self._listens[topic])}
        for topic in sorted(offered):
            qos = _offered_qos(self._peers(topic))
            self._publishers[topic] = self.node.create_publisher(self._offers[topic], topic, qos)
        for topic in sorted(listened):
            qos = _requested_qos(self._peers(topic))
            receive = self._receiver(topic)
            self._inbox.append((self.node.create_subscription(self._listens[topic], topic, receive, qos), receive))
        ours = [publisher.get_subscription_count for publisher in self._publishers.values()]
        self._await(lambda: all(count() for count in ours) and self._connected(offered | listened))

    def _peers(self, topic: str) -> list[Any]:
        find = (
            self.node.get_subscriptions_info_by_topic
            if topic in self._offers
            else self.node.get_publishers_info_by_topic
        )
        return [peer for peer in find(topic) if peer.node_name != NAME]

    def _same_type(self, topic: str, message: type) -> bool:
        package, kind = message.__module__.split(".")[:2]
        return all(peer.topic_type == f"{package}/{kind}/{message.__name__}" for peer in self._peers(topic))

    def _receiver(self, topic: str) -> Callable[[Any], None]:
        received = self._received[topic]
        return lambda message: received.append(Stamped(self.seconds, message))

    def _await(self, condition: Callable[[], bool]) -> None:
        met = self.wait_for(lambda: self._is_impersonated() or condition(), MEETING_SECONDS)
        if self._is_impersonated():
            sentence = (
                f"Your node is called {NAME}, which is the grader's own name: give it the name that is asked for."
            )
            raise StudentError(Diagnosis(Kind.RESERVED_NAME, sentence))
        if not met:
            raise GraderError(f"the grader and the student's node did not meet within {MEETING_SECONDS:.0f} s")

    def _is_impersonated(self) -> bool:
        return bool(self.node.get_node_names().count(NAME) > 1)

    def _spin(self, timeout: float) -> None:
        """Take what has arrived; wait for something at most `timeout` seconds.

        rclpy's executors do the same, at several times the cost.
        """
        wait_set = rclpy_implementation.WaitSet(len(self._inbox), 1, 0, 0, 0, 0, self._context.handle)
        wait_set.clear_entities()
        wait_set.add_guard_condition(self._bell.handle)  # never rung: a wait set must not be empty
        for subscription, _ in self._inbox:
            wait_set.add_subscription(subscription.handle)
        wait_set.wait(int(timeout * 1e9))
        for subscription, receive in self._inbox:
            while (taken := subscription.handle.take_message(subscription.msg_type, False)) is not None:
                receive(taken[0])


def _offered_qos(peers: list[Any]) -> QoSProfile:
    """Return a publisher's profile that serves every subscription, however much it asks for."""
    durable = any(peer.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for peer in peers)
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=DEPTH,
        reliability=ReliabilityPolicy.RELIABLE,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if durable else DurabilityPolicy.VOLATILE,
    )


def _requested_qos(peers: list[Any]) -> QoSProfile:
    """Return a subscription's profile that each publisher can serve, however little it offers."""
    reliable = all(peer.qos_profile.reliability == ReliabilityPolicy.RELIABLE for peer in peers)
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=DEPTH,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.VOLATILE,
    )
