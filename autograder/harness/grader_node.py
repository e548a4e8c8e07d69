"""The grader's own end of every conversation: one node, what it publishes, hears, asks and answers.

It counts by channel what it has sent and what it has taken, as the programs do (see `lockstep_host`). So a harness
in lockstep knows when it has heard all that was said.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import rclpy
from rclpy.context import Context
from rclpy.guard_condition import GuardCondition
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

from autograder.lockstep.lockstep_host import channels
from autograder.ros.discovery import announcing_often

DEPTH = 1000
NAME = "grader"

Handler = Callable[[Any], Any]
Receiver = Callable[[Any, int], None]
"""Gets a message, and when it arrived, in nanoseconds since the epoch."""


@dataclass(eq=False)
class Ear:
    """Something that takes messages.

    Attributes:
        kind: subscription, client or service.
        channels: what it takes.
        entity: rclpy's object.
        take: takes one message and deals with it; False when there is none.
        count: how many it has taken.
        expected: how many were sent to it, as far as is known.
        latched: whether it takes what publishers keep for those who come late.
        new: whether it is still to be told what they keep.
    """

    kind: str
    channels: tuple[str, ...]
    entity: Any
    take: Callable[[], bool]
    count: int = 0
    expected: int = 0
    latched: bool = False
    new: bool = True

    def empty(self) -> None:
        """Take all that has arrived."""
        while self.take():
            self.count += 1


class GraderNode:
    """The grader's node in one DDS domain."""

    def __init__(self, domain: int) -> None:
        self.context = Context()
        with announcing_often():
            rclpy.init(args=[], context=self.context, domain_id=domain)
            self.node = Node(NAME, context=self.context, enable_rosout=False, start_parameter_services=False)
        self.publishers: dict[str, Any] = {}
        self.written: dict[str, str] = {}  # channels of the publishers, by topic
        self.ears: list[Ear] = []
        self.sent: Counter[str] = Counter()  # by channel, since the programs were last told
        self._clients: dict[tuple[str, str], Any] = {}
        self._waiting: dict[tuple[int, int], Callable[[Any], None]] = {}  # by client and sequence number
        self._bell = GuardCondition(callback=None, callback_group=None, context=self.context)
        self._prefix = ""

    def close(self) -> None:
        """Leave the domain."""
        self.node.destroy_node()
        self.context.try_shutdown()

    def offer(self, topic: str, kind: Any, peers: list[Any]) -> None:
        """Make a publisher that serves every one of the subscriptions `peers`, however much it asks for."""
        qos = offered_qos(peers)
        self.publishers[topic] = self.node.create_publisher(kind, topic, qos)
        self.written[topic] = channels.written(topic, kind, qos)

    def listen(self, topic: str, kind: Any, peers: list[Any], receive: Receiver) -> None:
        """Make a subscription that each of the publishers `peers` can serve, however little it offers."""
        qos = requested_qos(peers)
        subscription = self.node.create_subscription(kind, topic, receive, qos)

        def take() -> bool:
            taken = subscription.handle.take_message(kind, False)
            if taken is not None:
                receive(taken[0], taken[1]["received_timestamp"])
            return taken is not None

        latched = qos.durability == DurabilityPolicy.TRANSIENT_LOCAL
        self.ears.append(Ear("subscription", channels.read(topic, kind, qos), subscription, take, latched=latched))

    def publish(self, topic: str, message: Any) -> None:
        """Publish on a topic that is offered."""
        self.publishers[topic].publish(message)
        self.sent[self.written[topic]] += 1

    def client(self, kind: Any, name: str) -> Any:
        """Return the client of a service, made when it is first asked for.

        None if this process knows the service by another type: DDS allows one of each name in a process.
        """
        channel = channels.request(name, kind)
        if (name, channel) not in self._clients:
            try:
                client = self._clients[(name, channel)] = self.node.create_client(kind, name)
            except rclpy_implementation.RCLError:
                return None

            def take() -> bool:
                taken = client.handle.take_response(kind.Response)
                if taken is None or taken[0] is None:
                    return False
                then = self._waiting.pop((id(client), taken[0].request_id.sequence_number), None)
                if then is not None:
                    then(taken[1])
                return True

            answers = channels.response(name, kind, self.prefix())
            self.ears.append(Ear("client", (answers,), client, take))
        return self._clients[(name, channel)]

    def ask(self, kind: Any, name: str, request: Any, then: Callable[[Any], None]) -> None:
        """Send a request; `then` gets the response."""
        client = self.client(kind, name)
        sequence = client.handle.send_request(request)
        self._waiting[(id(client), sequence)] = then
        self.sent[channels.request(name, kind)] += 1

    def serve(self, kind: Any, name: str, handler: Handler) -> None:
        """Answer the requests to a service; where `handler` returns None, never."""
        service = self.node.create_service(kind, name, lambda request, response: response)

        def take() -> bool:
            request, header = service.handle.service_take_request(kind.Request)
            if header is None:
                return False
            answer = handler(request)
            if answer is not None:
                service.send_response(answer, header)
                self.sent[channels.response(name, kind, channels.client_prefix(header.request_id))] += 1
            return True

        self.ears.append(Ear("service", (channels.request(name, kind),), service, take))

    def clients(self) -> list[tuple[str, Any]]:
        """Return each client with the channel of its requests."""
        return [(channel, client) for (_, channel), client in self._clients.items()]

    def prefix(self) -> str:
        """Return the prefix of this process's GUIDs."""
        self._prefix = self._prefix or channels.own_prefix(self.node)
        return self._prefix

    def hear(self) -> bool:
        """Take what has arrived where something is expected; return whether all of that has come."""
        for ear in self.ears:
            if ear.count < ear.expected:
                ear.empty()
        return all(ear.count >= ear.expected for ear in self.ears)

    def spin(self, timeout: float) -> None:
        """Take what has arrived; wait for something at most `timeout` seconds.

        rclpy's executors do the same, at several times the cost.
        """
        ears = list(self.ears)
        numbers = Counter(ear.kind for ear in ears)
        wait_set = rclpy_implementation.WaitSet(
            numbers["subscription"], 1, 0, numbers["client"], numbers["service"], 0, self.context.handle
        )
        wait_set.clear_entities()
        wait_set.add_guard_condition(self._bell.handle)  # never rung: a wait set must not be empty
        add = {
            "subscription": wait_set.add_subscription,
            "client": wait_set.add_client,
            "service": wait_set.add_service,
        }
        for ear in ears:
            add[ear.kind](ear.entity.handle)
        wait_set.wait(int(timeout * 1e9))
        for ear in ears:
            ear.empty()


def offered_qos(peers: list[Any]) -> QoSProfile:
    """Return a publisher's profile that serves every subscription, however much it asks for."""
    durable = any(peer.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for peer in peers)
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=DEPTH,
        reliability=ReliabilityPolicy.RELIABLE,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if durable else DurabilityPolicy.VOLATILE,
    )


def requested_qos(peers: list[Any]) -> QoSProfile:
    """Return a subscription's profile that each publisher can serve, however little it offers."""
    reliable = all(peer.qos_profile.reliability == ReliabilityPolicy.RELIABLE for peer in peers)
    durable = bool(peers) and all(p.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for p in peers)
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=DEPTH,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if durable else DurabilityPolicy.VOLATILE,
    )
