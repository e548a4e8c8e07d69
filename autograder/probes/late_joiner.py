"""Tests which messages a publisher has kept for a subscription that joins late."""

from __future__ import annotations

import time

import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile

from autograder.ros.discovery import announcing_often

DEPTH = 10  # more than a publisher should keep
JOIN_SECONDS = 30.0  # of real time until the first message has come; only a publisher that keeps none takes so long
REST_SECONDS = 0.3  # of real time in which the others follow: they are sent together


def kept_messages(present: Node, topic: str, kind: type) -> int:
    """Return how many messages a transient local subscription gets that joins now, `DEPTH` at most.

    The publisher must not publish meanwhile: in lockstep it does not.

    Args:
        present: a node in the domain of the publisher. The late subscription has a separate context.
        topic: the fully qualified name of the topic.
        kind: its type.
    """
    received: list[object] = []
    context = Context()
    with announcing_often():
        rclpy.init(args=[], context=context, domain_id=present.context.get_domain_id())
    node = Node("late_joiner", context=context, enable_rosout=False, start_parameter_services=False)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    try:
        profile = QoSProfile(depth=DEPTH, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node.create_subscription(kind, topic, received.append, profile)
        deadline = time.monotonic() + JOIN_SECONDS
        while not received and time.monotonic() < deadline:
            executor.spin_once(timeout_sec=0.1)
        deadline = time.monotonic() + REST_SECONDS
        while time.monotonic() < deadline and len(received) < DEPTH:  # a flood would fill the memory
            executor.spin_once(timeout_sec=0.05)
        return len(received)
    finally:
        executor.shutdown()
        node.destroy_node()
        context.try_shutdown()
