"""Whether a subscription hears a driver, which publishes as a plain 10 says and keeps nothing for late joiners."""

from __future__ import annotations

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy

from autograder.checking import expect


def expect_heard(node: Node, topic: str) -> None:
    """Fail the check if a subscription asks for messages that were kept; half of the points for what it does."""
    for peer in node.get_subscriptions_info_by_topic(topic):
        kept = peer.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
        expect(not kept, f"{topic} is subscribed to with transient local durability: it hears no driver.", fraction=0.5)
