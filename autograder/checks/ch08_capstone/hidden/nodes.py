"""Step 2, the nodes: their names and endpoints in the ROS graph."""

from __future__ import annotations

from rclpy.qos import DurabilityPolicy, ReliabilityPolicy

from autograder.checking import Workspace, expect, group, hint
from autograder.checking.probes import namespaces
from autograder.checks.ch08_capstone.hidden.graph import expect_endpoints, names_of
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import CONTROLLER, MONITOR, PROCESSOR, PROGRAMS
from autograder.checks.ch08_capstone.support.system import SharedSystem

check = group("step_2")
MESSAGE_CHECKS = ("clearance_message", "interface_package")
ENDPOINT_HINTS = (
    "Start the node in a terminal, then look at it: ros2 node info /navigation_controller.",
    "Use relative names, without a leading slash: create_publisher(Twist, 'cmd_vel', 10).",
)


@check(points=1, covers="processor-name", needs=("build",), after=MESSAGE_CHECKS, doc=contract.NODES_DOC)
@hint(*ENDPOINT_HINTS)
def test_processor(shared_system: SharedSystem) -> None:
    """The node sensor_processor runs under its name, and its topics have the types of the contract."""
    expect_endpoints(shared_system.get(PROCESSOR).harness, PROCESSOR)


@check(points=1, covers="controller-name", needs=("build",), after=MESSAGE_CHECKS, doc=contract.NODES_DOC)
@hint(*ENDPOINT_HINTS)
def test_controller(shared_system: SharedSystem) -> None:
    """The node navigation_controller runs under its name; its topics and its service have the types of the contract."""
    expect_endpoints(shared_system.get(CONTROLLER).harness, CONTROLLER)


@check(
    points=1, covers="monitor-name", needs=("build",), after=(*MESSAGE_CHECKS, "health_message"), doc=contract.NODES_DOC
)
@hint(*ENDPOINT_HINTS)
def test_monitor(shared_system: SharedSystem) -> None:
    """The node status_monitor runs under its name, and its topics have the types of the contract."""
    expect_endpoints(shared_system.get(MONITOR).harness, MONITOR)


@check(
    points=1, covers="relative", needs=("build",), after=("processor", "controller", "monitor"), doc=contract.NODES_DOC
)
@hint("A name that begins with a slash is the same in every namespace: two robots would share it.")
@hint("'scan' is relative, '/scan' is not.")
def test_relative(workspace: Workspace) -> None:
    """The names of all topics and of the service are relative: in the namespace /a, scan is /a/scan."""
    errors = [
        error
        for name in PROGRAMS
        if (error := namespaces.missing_in_namespace(workspace, contract.PACKAGE, name, names_of(name)))
    ]
    expect(not errors, " ".join(errors))


@check(
    points=2,
    covers=("processor", "late-joiner"),
    needs=("build",),
    after=("processor", "monitor"),
    doc=contract.QOS_DOC,
)
@hint("A lidar publishes scan best-effort, so subscribe with qos_profile_sensor_data.")
@hint("QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL) keeps the last report for late joiners.")
def test_qos(shared_system: SharedSystem) -> None:
    """Both subscriptions to scan accept a best-effort lidar, and a late subscriber to health gets the last report."""
    graph = shared_system.get(PROCESSOR, MONITOR).harness.node
    subscriptions, publishers = (
        graph.get_subscriptions_info_by_topic("/scan"),
        graph.get_publishers_info_by_topic("/health"),
    )
    expect(bool(subscriptions), "No node subscribes to scan.")
    expect(bool(publishers), "No node publishes health.", fraction=0.5)
    for endpoint in subscriptions:
        is_reliable = endpoint.qos_profile.reliability == ReliabilityPolicy.RELIABLE
        expect(
            not is_reliable,
            f"{endpoint.node_name} requests reliable scans, so it would get none from a best-effort lidar.",
            fraction=0.5,
        )
    for endpoint in publishers:
        is_durable = endpoint.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
        expect(
            is_durable,
            f"{endpoint.node_name} publishes health as volatile: a late subscriber does not get the last report.",
            fraction=0.5,
        )
