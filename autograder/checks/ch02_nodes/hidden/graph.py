"""Checks of the node in the ROS graph: its name, and the names, types and QoS of its topics."""

from __future__ import annotations

import pytest

from autograder.checking import CheckFailed, Workspace, expect, group, hint
from autograder.checking.probes import namespaces, qos
from autograder.checks.ch02_nodes.support import contract
from autograder.checks.ch02_nodes.support.robot import Robot, qos_mismatch

check = group("graph")


@check(points=1, covers="node-name", doc=contract.NODES)
@hint("Run the cell that builds the workspace and read the last lines of its output.")
@hint("setup.py must list robot_controller = my_robot_package.nodes.robot_controller:main in console_scripts.")
def test_starts(robot: Robot) -> None:
    """The executable robot_controller starts and its node spins."""
    robot.require_running()


@check(points=1, covers="node-name", needs=("starts",))
@hint("The name is the argument of super().__init__.")
def test_node_name(robot: Robot) -> None:
    """The node is called robot_controller."""
    names = robot.nodes()
    expect(
        contract.NODE in names, f"There is no node {contract.NODE}. Nodes in the graph: {', '.join(names) or 'none'}."
    )


@check(points=1, covers="scan", needs=("starts",))
@hint("create_subscription(LaserScan, 'scan', self.scan_callback, ...) in __init__.")
def test_subscribes_scan(robot: Robot) -> None:
    """It subscribes to scan as sensor_msgs/msg/LaserScan."""
    _expect_endpoint(robot, "subscription", "/scan", "sensor_msgs/msg/LaserScan")


@check(points=2, covers=("scan", "cmd-vel", "status"), needs=("subscribes_scan",), doc=contract.QOS)
@hint("A lidar publishes best-effort; a reliable subscription never matches it.")
@hint("Give create_subscription qos_profile_sensor_data instead of 10.")
def test_scan_qos(robot: Robot) -> None:
    """Its scan subscription matches a best-effort lidar, and cmd_vel and status have a plain queue of 10."""
    reason = qos_mismatch(robot)
    expect(not reason, f"The subscription would never receive a scan from a best-effort lidar: {reason}.")
    difference = qos.non_default_qos(robot.node, "/cmd_vel", "/status")
    expect(not difference, difference, fraction=0.5)


@check(points=1, covers=("cmd-vel", "twist"), needs=("starts",))
@hint("create_publisher(Twist, 'cmd_vel', 10) in __init__.")
def test_publishes_cmd_vel(robot: Robot) -> None:
    """It publishes cmd_vel as geometry_msgs/msg/Twist."""
    _expect_endpoint(robot, "publisher", "/cmd_vel", "geometry_msgs/msg/Twist")


@check(points=1, covers="status", needs=("starts",))
@hint("create_subscription(String, 'status', self.status_callback, 10) in __init__.")
def test_subscribes_status(robot: Robot) -> None:
    """It subscribes to status as std_msgs/msg/String."""
    _expect_endpoint(robot, "subscription", "/status", "std_msgs/msg/String")


@check(
    points=1,
    covers=("relative", "kwargs"),
    needs=("starts",),
    after=("subscribes_scan", "publishes_cmd_vel", "subscribes_status"),
)
@hint("A name that begins with a slash is the same in every namespace: two robots would share it.")
@hint("'scan' is relative, '/scan' is not.")
def test_relative(workspace: Workspace, robot: Robot, request: pytest.FixtureRequest) -> None:
    """All topic names are relative: in the namespace /a, scan becomes /a/scan."""
    node = robot.node
    topics = [topic for topic in ("scan", "status") if node.get_subscriptions_info_by_topic(f"/{topic}")]
    topics += ["cmd_vel"] if node.get_publishers_info_by_topic("/cmd_vel") else []
    expect(bool(topics), "It has none of the topics scan, status and cmd_vel.")
    reason = namespaces.missing_in_namespace(workspace, contract.PACKAGE, contract.EXECUTABLE, tuple(topics))
    expect(not reason, reason)
    problem = request.getfixturevalue("two_nodes").argument_problem()
    expect(not problem, problem, fraction=0.5)


def _expect_endpoint(robot: Robot, kind: str, topic: str, type_name: str) -> None:
    find_endpoints = (
        robot.node.get_publishers_info_by_topic if kind == "publisher" else robot.node.get_subscriptions_info_by_topic
    )
    types = sorted({peer.topic_type for peer in find_endpoints(topic) if peer.node_name != "grader"})
    if not types:
        list_by_node = (
            robot.node.get_publisher_names_and_types_by_node
            if kind == "publisher"
            else robot.node.get_subscriber_names_and_types_by_node
        )
        names = [
            name
            for node, namespace in robot.node.get_node_names_and_namespaces()
            if node != "grader"
            for name, _ in list_by_node(node, namespace)
            if name not in ("/rosout", "/parameter_events", "/clock")
        ]
        endpoints = f"the node's {kind}s are on {', '.join(sorted(names))}" if names else f"the node has no {kind}"
        raise CheckFailed(f"There is no {kind} on {topic}: {endpoints}.")
    expect(types == [type_name], f"The {kind} on {topic} has the type {', '.join(types)} instead of {type_name}.")
