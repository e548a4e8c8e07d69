"""The expected endpoints of the three nodes in the ROS graph."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from rclpy.node import Node

from autograder.checking import Harness, expect, nearest
from autograder.checks.ch08_capstone.support.contract import CONTROLLER, INTERFACES, MONITOR, PROCESSOR

_SCAN, _CLEARANCE = "sensor_msgs/msg/LaserScan", f"{INTERFACES}/msg/Clearance"
_TWIST, _HEALTH = "geometry_msgs/msg/Twist", f"{INTERFACES}/msg/Health"


@dataclass(frozen=True)
class Endpoint:
    """An endpoint of a topic or service: its node, kind, name and type."""

    node: str
    kind: str
    name: str
    type: str


ENDPOINTS = (
    Endpoint(PROCESSOR, "subscription", "/scan", _SCAN),
    Endpoint(PROCESSOR, "publisher", "/clearance", _CLEARANCE),
    Endpoint(CONTROLLER, "subscription", "/clearance", _CLEARANCE),
    Endpoint(CONTROLLER, "publisher", "/cmd_vel", _TWIST),
    Endpoint(CONTROLLER, "service", "/enable", "std_srvs/srv/SetBool"),
    Endpoint(MONITOR, "subscription", "/scan", _SCAN),
    Endpoint(MONITOR, "subscription", "/clearance", _CLEARANCE),
    Endpoint(MONITOR, "subscription", "/cmd_vel", _TWIST),
    Endpoint(MONITOR, "publisher", "/health", _HEALTH),
)


def names_of(node: str) -> list[str]:
    """Return the relative names of a node's topics and services."""
    return [endpoint.name.removeprefix("/") for endpoint in ENDPOINTS if endpoint.node == node]


def expect_endpoints(harness: Harness, name: str) -> None:
    """Fail the check unless a node runs under its name and has all its endpoints.

    Args:
        harness: the student's programs.
        name: the name of the node.
    """
    nodes = harness.nodes()
    expect(f"/{name}" in nodes, f"No node is called /{name}. Running nodes: {', '.join(nodes) or 'none'}.")
    expected = [endpoint for endpoint in ENDPOINTS if endpoint.node == name]
    faults = [fault for endpoint in expected if (fault := _describe_fault(harness.node, endpoint))]
    expect(not faults, " ".join(faults), fraction=round(max(0.0, 1.0 - len(faults) / len(expected)), 2))


def _describe_fault(node: Node, expected: Endpoint) -> str:
    endpoints = dict(_graph_query(node, expected.kind)(expected.node, "/"))
    types = endpoints.get(expected.name)
    if types is None:
        similar = nearest(expected.name, endpoints, 0.5)
        similar_text = f"; it has {similar}" if similar else ""
        return f"{expected.node} has no {expected.kind} {expected.name}{similar_text}."
    if list(types) != [expected.type]:
        return f"{expected.node}: {expected.name} has the type {', '.join(types)}, instead of {expected.type}."
    return ""


def _graph_query(node: Node, kind: str) -> Callable[[str, str], list[tuple[str, list[str]]]]:
    queries: dict[str, Callable[[str, str], list[tuple[str, list[str]]]]] = {
        "publisher": node.get_publisher_names_and_types_by_node,
        "subscription": node.get_subscriber_names_and_types_by_node,
        "service": node.get_service_names_and_types_by_node,
    }
    return queries[kind]
