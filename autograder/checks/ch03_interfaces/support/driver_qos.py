"""Tests whether a subscription matches a driver that publishes with the default QoS profile, which is volatile."""

from __future__ import annotations

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy

from autograder.checking import expect


def expect_volatile(node: Node, topic: str) -> None:
    """Fail the check, with half of the points, if a subscription to the topic is transient local."""
    for peer in node.get_subscriptions_info_by_topic(topic):
        is_transient = peer.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
        expect(
            not is_transient,
            f"The subscription to {topic} is transient local, so it receives nothing from a volatile publisher.",
            fraction=0.5,
        )
