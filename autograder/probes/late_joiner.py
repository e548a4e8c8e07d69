"""Counts the messages that a publisher has kept for a subscription that joins late."""

from __future__ import annotations

import time

import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile

from autograder.harness.inflow import Inflow
from autograder.ros.discovery import fast_discovery

DEPTH = 10  # more messages than a publisher should keep
JOIN_SECONDS = 30.0  # real time to wait for the first message; only a publisher that keeps none takes so long
FURTHER_SECONDS = 0.3  # real time to wait for the other messages, which are sent together with the first


def count_kept_messages(node: Node, topic: str, kind: type) -> int:
    """Return how many messages a new transient local subscription receives, at most `DEPTH`.

    The publisher must not publish meanwhile, and in lockstep it does not.

    Args:
        node: a node in the domain of the publisher. The new subscription has a separate context.
        topic: the fully qualified name of the topic.
        kind: the type of the topic.

    Raises:
        StudentError: the messages are too large. They are counted, and never parsed.
    """
    received, inflow = 0, Inflow()

    def receive(data: bytes) -> None:
        nonlocal received
        inflow.add(topic, len(data))
        received += 1

    context = Context()
    with fast_discovery():
        rclpy.init(args=[], context=context, domain_id=node.context.get_domain_id())
    late_node = Node("late_joiner", context=context, enable_rosout=False, start_parameter_services=False)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(late_node)
    try:
        profile = QoSProfile(depth=DEPTH, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        late_node.create_subscription(kind, topic, receive, profile, raw=True)
        deadline = time.monotonic() + JOIN_SECONDS
        while not received and time.monotonic() < deadline:
            executor.spin_once(timeout_sec=0.1)
        deadline = time.monotonic() + FURTHER_SECONDS
        while time.monotonic() < deadline and received < DEPTH:  # so that a publisher cannot fill the memory
            executor.spin_once(timeout_sec=0.05)
        return received
    finally:
        executor.shutdown()
        late_node.destroy_node()
        context.try_shutdown()
