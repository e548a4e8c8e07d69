"""Tests the quality of service of endpoints for which the contract specifies only the length of the queue."""

from __future__ import annotations

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy


def non_default_qos(node: Node, *topics: str) -> str:
    """Describe the first endpoint on the topics that is not reliable and volatile, as `10` is; "" if all are.

    The length of a queue is not visible in the graph. `node` is the grader's, and its endpoints do not count.
    """
    for topic in topics:
        publishers = node.get_publishers_info_by_topic(topic)
        subscriptions = node.get_subscriptions_info_by_topic(topic)
        for kind, peers in (("publisher", publishers), ("subscription", subscriptions)):
            for peer in (peer for peer in peers if peer.node_name != node.get_name()):
                policy = "best effort" if peer.qos_profile.reliability != ReliabilityPolicy.RELIABLE else ""
                if peer.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL:
                    policy = "transient local"
                if policy:
                    advice = "with only a queue length, such as 10, it is reliable and volatile"
                    return f"The {kind} on {topic} is {policy}: {advice}."
    return ""
