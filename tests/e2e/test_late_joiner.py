"""A probe counts the messages that a publisher keeps for subscriptions that join late, over DDS."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
import rclpy
from rclpy.context import Context
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

from autograder.exceptions import StudentError
from autograder.harness.inflow import Inflow
from autograder.probes import late_joiner
from autograder.probes.late_joiner import count_kept_messages
from autograder.ros.domains import Domain
from autograder.run.sandbox.limits import MessageLimits


@pytest.fixture
def node() -> Iterator[Node]:
    """A node in a separate domain."""
    with Domain() as domain:
        context = Context()
        rclpy.init(args=[], context=context, domain_id=domain.number)
        node = Node("publisher", context=context)
        yield node
        node.destroy_node()
        context.try_shutdown()


@pytest.mark.parametrize("depth", [1, 3])
def test_a_late_joiner_counts_the_messages_that_a_publisher_keeps(node: Node, depth: int) -> None:
    publisher = node.create_publisher(
        String, "/status", QoSProfile(depth=depth, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    )
    for number in range(5):
        publisher.publish(String(data=str(number)))
    assert count_kept_messages(node, "/status", String) == depth


def test_messages_that_are_too_large_are_refused(node: Node, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(late_joiner, "Inflow", lambda: Inflow(MessageLimits(messages=10, size=10_000)))
    publisher = node.create_publisher(
        String, "/status", QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    )
    for _ in range(3):
        publisher.publish(String(data="x" * 6_000))
    with pytest.raises(StudentError, match="on /status, but the grader accepts at most 10 messages"):
        count_kept_messages(node, "/status", String)
