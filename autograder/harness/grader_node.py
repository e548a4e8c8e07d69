"""The grader's node: its publishers, subscriptions and clients.

Like the programs (see `lockstep_host`), it counts the messages that it has sent and taken on each channel. This is how
a harness in lockstep knows when it has taken every message.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import rclpy
from rclpy.context import Context
from rclpy.guard_condition import GuardCondition
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message

from autograder.harness.inflow import Inflow
from autograder.ros.discovery import fast_discovery
from autograder.run.lockstep.lockstep_host import channels

DEPTH = 1000  # length of the queues of its publishers and subscriptions
NAME = "grader"
UNKNOWN_NODE = "_NODE_NAME_UNKNOWN_"  # what rmw_dds_common calls the node of an endpoint until the node is discovered

OnMessage = Callable[[Any, int], None]
"""Called with a message and the time at which it arrived, in ns since the epoch."""

OnExchange = Callable[[str, str, Any], None]
"""Called with the kind of event, as in `exchanges.Exchange`, the name of the service or topic, and the message."""


@dataclass(eq=False)
class GraderReader:
    """A subscription or client of the grader, which takes messages."""

    kind: str  # "subscription" or "client"
    channels: tuple[str, ...]  # the channels that it receives from
    entity: Any  # rclpy's object
    take: Callable[[], bool]  # takes and handles one message; False if none has arrived
    count: int = 0  # number of messages that it has taken
    expected: int = 0  # number of messages that were sent to it, as far as is known
    transient_local: bool = False  # whether it receives messages that publishers keep for late subscriptions
    is_new: bool = True  # whether such messages are not yet included in `expected`

    def drain(self) -> None:
        """Take the messages that have arrived, at most a full queue: a program may send faster than they are taken."""
        for _ in range(DEPTH):
            if not self.take():
                return
            self.count += 1


class GraderNode:
    """The grader's node in one DDS domain.

    Attributes:
        publishers: the publishers, by topic.
        publisher_channels: the channels of the publishers, by topic.
        readers: the subscriptions and clients.
        sent: the number of messages sent on each channel since the programs were last informed.
        on_exchange: called for each request, response and feedback message.
    """

    def __init__(self, domain: int, on_exchange: OnExchange = lambda kind, name, message: None) -> None:
        self.on_exchange = on_exchange
        self.context = Context()
        with fast_discovery():
            rclpy.init(args=[], context=self.context, domain_id=domain)
            self.node = Node(NAME, context=self.context, enable_rosout=False, start_parameter_services=False)
        self.publishers: dict[str, Any] = {}
        self.publisher_channels: dict[str, str] = {}
        self.readers: list[GraderReader] = []
        self.sent: Counter[str] = Counter()
        self._clients: dict[tuple[str, str], Any] = {}
        self._callbacks: dict[tuple[int, int], Callable[[Any], None]] = {}  # by client and sequence number
        self._unused_guard = GuardCondition(callback=None, callback_group=None, context=self.context)
        self._inflow = Inflow()
        self._prefix = ""  # the prefix of this process's GUIDs

    def close(self) -> None:
        """Leave the domain."""
        self.node.destroy_node()
        self.context.try_shutdown()

    def make_publisher(self, topic: str, kind: Any) -> None:
        """Create a publisher compatible with all visible subscriptions, unless it exists or the types differ."""
        peers = self.subscriptions_of(topic)
        if topic in self.publishers or not _have_type(kind, peers):
            return
        qos = offered_qos(peers)
        self.publishers[topic] = self.node.create_publisher(kind, topic, qos)
        self.publisher_channels[topic] = channels.publisher_channel(topic, kind, qos)

    def make_subscription(self, topic: str, kind: Any, receive: OnMessage) -> None:
        """Create a subscription compatible with all visible publishers, unless it exists or the types differ."""
        peers = self.publishers_of(topic)
        subscribed_topics = (reader.entity.topic_name for reader in self.readers if reader.kind == "subscription")
        if topic not in subscribed_topics and _have_type(kind, peers):
            self.subscribe(topic, kind, receive, requested_qos(peers))

    def subscribe(self, topic: str, kind: Any, receive: OnMessage, qos: QoSProfile) -> None:
        """Create a subscription with a QoS profile. `receive` is called with each message."""
        subscription = self.node.create_subscription(kind, topic, receive, qos)

        def take() -> bool:
            received = subscription.handle.take_message(kind, True)
            if received is None:
                return False
            self._inflow.add(topic, len(received[0]))
            with suppress(rclpy_implementation.RMWError, TypeError):
                message = deserialize_message(received[0], kind)
                if message is not None:  # None or an error if the bytes are not a message of this type
                    receive(message, received[1]["received_timestamp"])
            return True

        transient_local = qos.durability == DurabilityPolicy.TRANSIENT_LOCAL
        self.readers.append(
            GraderReader(
                "subscription",
                channels.subscription_channels(topic, kind, qos),
                subscription,
                take,
                transient_local=transient_local,
            )
        )

    def publish(self, topic: str, message: Any) -> None:
        """Publish a message on a topic for which a publisher was created."""
        self.publishers[topic].publish(message)
        self.sent[self.publisher_channels[topic]] += 1

    def client(self, kind: Any, name: str) -> Any:
        """Return the client of a service. It is created on first use.

        Return None if this process already uses the service with another type: DDS allows only one type per name.
        """
        channel = channels.request(name, kind)
        if (name, channel) not in self._clients:
            try:
                client = self._clients[(name, channel)] = self.node.create_client(kind, name)
            except rclpy_implementation.RCLError:
                return None

            def take() -> bool:
                received = client.handle.take_response(kind.Response)
                if received is None or received[0] is None:
                    return False
                callback = self._callbacks.pop((id(client), received[0].request_id.sequence_number), None)
                if callback is not None and received[1] is not None:
                    callback(received[1])
                return True

            self._prefix = self._prefix or channels.own_prefix(self.node)
            self.readers.append(GraderReader("client", (channels.response(name, kind, self._prefix),), client, take))
        return self._clients[(name, channel)]

    def ask(self, kind: Any, name: str, request: Any, on_response: Callable[[Any], None]) -> None:
        """Send a request to a service. `on_response` is called with the response."""
        client = self.client(kind, name)
        self.on_exchange("asked", name, request)
        sequence = client.handle.send_request(request)

        def deliver(response: Any) -> None:
            self.on_exchange("answered", name, response)
            on_response(response)

        self._callbacks[(id(client), sequence)] = deliver
        self.sent[channels.request(name, kind)] += 1

    def clients(self) -> list[tuple[str, Any]]:
        """Return each client with the channel of its requests."""
        return [(channel, client) for (_, channel), client in self._clients.items()]

    def take_expected(self) -> bool:
        """Take expected messages that have arrived. Return whether none is missing."""
        for reader in self.readers:
            if reader.count < reader.expected:
                reader.drain()
        return all(reader.count >= reader.expected for reader in self.readers)

    def subscriptions_of(self, topic: str) -> list[Any]:
        """Return the other nodes' subscriptions to a topic, as rclpy's graph functions describe them."""
        return [peer for peer in self.node.get_subscriptions_info_by_topic(topic) if peer.node_name != NAME]

    def publishers_of(self, topic: str) -> list[Any]:
        """Return the other nodes' publishers of a topic, as rclpy's graph functions describe them."""
        return [peer for peer in self.node.get_publishers_info_by_topic(topic) if peer.node_name != NAME]

    def knows_nodes_of(self, topics: Iterable[str]) -> bool:
        """Return whether the node of each other endpoint of these topics is known."""
        peers = (peer for topic in topics for peer in (*self.publishers_of(topic), *self.subscriptions_of(topic)))
        return all(peer.node_name != UNKNOWN_NODE for peer in peers)

    def other_nodes(self) -> list[str]:
        """Return the fully qualified names of the other nodes that are visible now."""
        nodes = self.node.get_node_names_and_namespaces()
        return sorted(f"{space.rstrip('/')}/{name}" for name, space in nodes if name != NAME)

    def is_impersonated(self) -> bool:
        """Return whether another node has this node's name."""
        return bool(self.node.get_node_names().count(NAME) > 1)

    def spin(self, timeout: float) -> None:
        """Take all messages that have arrived. If none has, wait for one for at most `timeout` seconds.

        rclpy's executors do the same, at several times the cost.
        """
        readers = list(self.readers)
        numbers = Counter(reader.kind for reader in readers)
        wait_set = rclpy_implementation.WaitSet(
            numbers["subscription"], 1, 0, numbers["client"], 0, 0, self.context.handle
        )
        wait_set.clear_entities()
        wait_set.add_guard_condition(self._unused_guard.handle)  # a wait set must not be empty
        add = {"subscription": wait_set.add_subscription, "client": wait_set.add_client}
        for reader in readers:
            add[reader.kind](reader.entity.handle)
        wait_set.wait(int(timeout * 1e9))
        for reader in readers:
            reader.drain()


def _have_type(kind: Any, peers: list[Any]) -> bool:
    return all(peer.topic_type == channels.type_name(kind) for peer in peers)


def offered_qos(peers: list[Any]) -> QoSProfile:
    """Return a QoS profile for a publisher that is compatible with all these subscriptions."""
    is_durable = any(peer.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for peer in peers)
    return QoSProfile(
        depth=DEPTH,
        reliability=ReliabilityPolicy.RELIABLE,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if is_durable else DurabilityPolicy.VOLATILE,
    )


def requested_qos(peers: list[Any]) -> QoSProfile:
    """Return a QoS profile for a subscription that is compatible with all these publishers."""
    is_reliable = all(peer.qos_profile.reliability == ReliabilityPolicy.RELIABLE for peer in peers)
    is_durable = bool(peers) and all(p.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for p in peers)
    return QoSProfile(
        depth=DEPTH,
        reliability=ReliabilityPolicy.RELIABLE if is_reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if is_durable else DurabilityPolicy.VOLATILE,
    )
