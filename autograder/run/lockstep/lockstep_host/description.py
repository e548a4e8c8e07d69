"""Describes a program's nodes, so that the grader knows when all endpoints are matched."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from rclpy.action import ActionClient, ActionServer
from rclpy.clock import ClockType

from . import channels
from .message_counts import NOT_COUNTED, is_alive

_OWN_TOPICS = NOT_COUNTED | {"/parameter_events"}  # endpoints on these topics are not matched with others


def describe(nodes: list[Any]) -> dict[str, Any]:
    """Describe nodes: their endpoints by channel, each with the current number of its peers.

    `writers` are pairs of a channel and the number of subscriptions. `readers` are pairs of several channels and the
    number of publishers, None if that is unknown. `clients` are pairs of a request channel and whether a server exists.
    `servers` are request channels.
    """
    writers: list[Any] = []
    readers: list[Any] = []
    clients: list[Any] = []
    servers: list[str] = []
    for node in nodes:
        for publisher in _alive(node.publishers):
            if publisher.topic_name not in _OWN_TOPICS:
                channel = channels.publisher_channel(publisher.topic_name, publisher.msg_type, publisher.qos_profile)
                writers.append((channel, publisher.get_subscription_count()))
        for subscription in _alive(node.subscriptions):
            if subscription.topic_name not in NOT_COUNTED:
                names = channels.subscription_channels(
                    subscription.topic_name, subscription.msg_type, subscription.qos_profile
                )
                readers.append((names, subscription.handle.get_publisher_count()))
        for client in _alive(node.clients):
            clients.append((channels.request(client.service_name, client.srv_type), client.service_is_ready()))
        for service in _alive(node.services):
            servers.append(channels.request(service.service_name, service.srv_type))
        for waitable in node.waitables:
            if isinstance(waitable, ActionServer):
                servers += waitable.lockstep_requests
                topic = channels.topic_of(waitable.lockstep_feedback)
                writers.append((waitable.lockstep_feedback, node.count_subscribers(topic)))
            elif isinstance(waitable, ActionClient):
                clients += [(channel, waitable.server_is_ready()) for channel in waitable.lockstep_requests]
                readers.append((waitable.lockstep_feedback, None))
    timers = [timer for node in nodes for timer in _alive(node.timers)]
    return {
        "nodes": [node.get_fully_qualified_name() for node in nodes],
        "timers": [timer.timer_period_ns for timer in timers if timer.clock.clock_type == ClockType.ROS_TIME],
        "writers": writers,
        "readers": readers,
        "clients": clients,
        "servers": servers,
    }


def _alive(entities: Iterable[Any]) -> list[Any]:
    return [entity for entity in entities if is_alive(entity)]
