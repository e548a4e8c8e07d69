"""A probe counts the messages that a publisher keeps for subscriptions that join late, over DDS."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
import rclpy
from rclpy.context import Context
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

from autograder.probes.late_joiner import count_kept_messages
from autograder.ros.domains import Domain


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
