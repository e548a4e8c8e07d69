"""Channels have the same names on both sides, and connect the same endpoints as DDS."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Any

import pytest
import rclpy
from rclpy.context import Context
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy, qos_check_compatible
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String
from std_srvs.srv import Trigger

from autograder.run.lockstep.lockstep_host import channels
from autograder.run.lockstep.protocol import response_channel

SECONDS = 30.0
PROFILES = [
    QoSProfile(depth=1, reliability=reliability, durability=durability)
    for reliability in (ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT)
    for durability in (DurabilityPolicy.TRANSIENT_LOCAL, DurabilityPolicy.VOLATILE)
]


@pytest.fixture
def node(ros_domain: int) -> Iterator[Any]:
    context = Context()
    rclpy.init(args=[], context=context, domain_id=ros_domain)
    created = Node("channels", namespace="/here", context=context)
    yield created
    created.destroy_node()
    context.try_shutdown()


@pytest.mark.parametrize("offered", PROFILES)
@pytest.mark.parametrize("requested", PROFILES)
def test_a_subscription_is_joined_to_a_publisher_if_their_quality_of_service_fits(
    offered: QoSProfile, requested: QoSProfile
) -> None:
    compatible = qos_check_compatible(offered, requested)[0].name != "ERROR"  # a warning names liveliness
    published_channel, subscribed_channels = (
        channels.publisher_channel("/scan", LaserScan, offered),
        channels.subscription_channels("/scan", LaserScan, requested),
    )
    assert (published_channel in subscribed_channels) is compatible


def test_another_type_or_topic_is_another_channel() -> None:
    channel = channels.publisher_channel("/scan", LaserScan, PROFILES[0])
    assert channel == "/scan sensor_msgs/msg/LaserScan reliable transient_local"
    assert channel not in channels.subscription_channels("/scan", String, PROFILES[3])
    assert channel not in channels.subscription_channels("/scans", LaserScan, PROFILES[3])
    assert channels.topic_of(channel) == "/scan"
    assert channels.is_transient_local(channel)
    assert channels.is_topic(channel)


def test_requests_and_responses_are_named_alike_by_host_and_grader() -> None:
    request = channels.request("/ask", Trigger)
    assert not channels.is_topic(request)
    assert response_channel(request, "0a") == channels.response("/ask", Trigger, "0a")
    own_response = channels.response("/ask", Trigger, channels.OWN)
    assert channels.with_process_prefix((own_response, request), "0a") == (
        channels.response("/ask", Trigger, "0a"),
        request,
    )


def test_the_client_of_a_request_is_identified_by_its_process(node: Any) -> None:
    service = node.create_service(Trigger, "ask", lambda request, response: response)
    client = node.create_client(Trigger, "ask")
    deadline = time.monotonic() + SECONDS
    while not (client.service_is_ready() and channels.own_prefix(node)):
        assert time.monotonic() < deadline
    client.call_async(Trigger.Request())
    header = None
    while header is None:
        assert time.monotonic() < deadline
        _, header = service.handle.service_take_request(Trigger.Request)
    prefix = channels.client_prefix(header.request_id)
    assert len(prefix) == 2 * channels.PREFIX
    assert prefix == channels.own_prefix(node)
