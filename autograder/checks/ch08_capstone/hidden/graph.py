"""What the three nodes must have in the ROS graph, and what is there instead."""

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
    """One end of a topic or service: whose it is, what kind, its name and type."""

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
    """Fail the check unless a node is there under its name, with all its ends; say what is there instead.

    Args:
        harness: the student's programs.
        name: the node's.
    """
    nodes = harness.nodes()
    expect(f"/{name}" in nodes, f"No node is called /{name}; there is: {', '.join(nodes) or 'none'}.")
    wanted = [endpoint for endpoint in ENDPOINTS if endpoint.node == name]
    missing = [said for endpoint in wanted if (said := _describe_fault(harness.node, endpoint))]
    expect(not missing, " ".join(missing), fraction=round(max(0.0, 1.0 - len(missing) / len(wanted)), 2))


def _describe_fault(node: Node, wanted: Endpoint) -> str:
    found = dict(_find(node, wanted.kind)(wanted.node, "/"))
    types = found.get(wanted.name)
    if types is None:
        near = nearest(wanted.name, found, 0.5)
        instead = f"; it has {near}" if near else ""
        return f"{wanted.node} has no {wanted.kind} {wanted.name}{instead}."
    if list(types) != [wanted.type]:
        return f"{wanted.node}: {wanted.name} has the type {', '.join(types)}, instead of {wanted.type}."
    return ""


def _find(node: Node, kind: str) -> Callable[[str, str], list[tuple[str, list[str]]]]:
    finders: dict[str, Callable[[str, str], list[tuple[str, list[str]]]]] = {
        "publisher": node.get_publisher_names_and_types_by_node,
        "subscription": node.get_subscriber_names_and_types_by_node,
        "service": node.get_service_names_and_types_by_node,
    }
    return finders[kind]
