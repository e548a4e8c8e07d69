"""The quality of service of a program's endpoints, where the contract gives the length of a queue and nothing else."""

from __future__ import annotations

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy


def non_default_qos(node: Node, *topics: str) -> str:
    """Describe the first endpoint on the topics whose profile is not that of `10`, reliable and volatile; "" if none.

    Only the program knows the length of its queue. `node` is the grader's; its own endpoints do not count.
    """
    for topic in topics:
        published, taken = node.get_publishers_info_by_topic(topic), node.get_subscriptions_info_by_topic(topic)
        for kind, peers in (("publisher", published), ("subscription", taken)):
            for peer in (peer for peer in peers if peer.node_name != node.get_name()):
                differs = "best effort" if peer.qos_profile.reliability != ReliabilityPolicy.RELIABLE else ""
                if peer.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL:
                    differs = "transient local"
                if differs:
                    return f"The {kind} on {topic} is {differs}: a queue of 10 and no more is reliable and volatile."
    return ""
