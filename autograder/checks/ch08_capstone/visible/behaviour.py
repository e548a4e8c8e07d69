"""Steps 2 and 5: the reaction of the three nodes to a few scans, and their parameters."""

from __future__ import annotations

import math

from rclpy.qos import DurabilityPolicy
from std_srvs.srv import SetBool

from autograder.checking import check, expect, hint
from autograder.checking.probes import parameters
from autograder.checks.ch02_nodes.support.scans import Part, scan
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import (
    CONTROLLER,
    DEGRADED,
    FAILED,
    LEVELS,
    OK,
    PARAMETERS,
    PROGRAMS,
    TOLERANCE,
    name_of,
)
from autograder.checks.ch08_capstone.support.expectations import expect_driving, expect_still, expect_turning
from autograder.checks.ch08_capstone.support.system import System

OPEN = scan(fill=3.0)


@check(
    points=1,
    covers=("processor-name", "controller-name", "monitor-name"),
    group="step_2",
    needs=("package", "definitions", "interfaces_build"),
    doc=contract.NODES_DOC,
)
@hint("The sentence above names the error. The lines below it show where it happened.")
def test_starts(system: System) -> None:
    """Step 2: the three nodes start under their names."""
    nodes = system.harness.nodes()
    missing_nodes = [name_of(program) for program in PROGRAMS if name_of(program) not in nodes]
    expect(
        not missing_nodes,
        f"No node is called {' or '.join(missing_nodes)}. Running nodes: {', '.join(nodes) or 'none'}.",
    )


@check(points=1, covers=("processor", "sector"), group="step_2", needs=("starts",), doc=contract.SCAN_DOC)
@hint("A lidar publishes scan best-effort, so subscribe with qos_profile_sensor_data.")
@hint("A beam's bearing is angle_min + i * angle_increment, wrapped to (-pi, pi]; left is positive.")
def test_sees(system: System) -> None:
    """Step 2: sensor_processor publishes the distances ahead, on the left and on the right, and their validity."""
    published_scan = scan(Part(-5.0, 5.0, 1.0), Part(80.0, 90.0, 1.5), Part(-90.0, -80.0, 2.0), fill=3.0)
    clearances = system.publish_scans(published_scan).clearances
    expect(bool(clearances), "Scans were published, but no clearance.")
    newest = clearances[-1].message
    is_same_header = (
        newest.header.stamp == published_scan.header.stamp and newest.header.frame_id == published_scan.header.frame_id
    )
    expect(is_same_header, "The clearance's header differs from its scan's: copy the stamp and the frame.")
    distances = (newest.front, newest.left, newest.right)
    is_near = all(
        abs(distance - expected) <= TOLERANCE for distance, expected in zip(distances, (1.0, 1.5, 2.0), strict=True)
    )
    distances_text = ", ".join(f"{distance:.2f}" for distance in distances)
    expect(
        is_near and newest.valid,
        f"front, left and right were {distances_text} with valid {newest.valid}, "
        "instead of 1.00, 1.50, 2.00 with valid True.",
    )
    blind_clearances = system.publish_scans(scan(Part(-35.0, 35.0, math.nan))).clearances
    expect(
        bool(blind_clearances) and not blind_clearances[-1].message.valid,
        "With nan from every beam ahead, the newest clearance did not have valid False.",
    )


@check(points=1, covers=("drive", "turn", "untrusted"), group="step_2", needs=("sees",), doc=contract.NODES_DOC)
@hint("If there is no clearance, or it is not valid, or its stamp is too old, publish an unchanged Twist().")
@hint("Set linear.x to forward_speed if the way is clear. Otherwise set angular.z: turn to the side with more room.")
def test_moves(system: System) -> None:
    """Step 2: navigation_controller drives, turns, keeps the side of a turn, and stands still without valid data."""
    expect_still(system.before_first_scan.commands, "Before the first scan")
    expect_driving(system.publish_scans(OPEN).commands, "With 3 m of free space all around", 0.3)
    wall = scan(Part(-10.0, 10.0, 0.4), Part(70.0, 110.0, 1.0), fill=3.0)
    expect_turning(
        system.publish_scans(wall).commands, "With a wall 0.4 m ahead and less room on the left", "right", 0.8
    )
    wall = scan(Part(-10.0, 10.0, 0.4), Part(-110.0, -70.0, 0.9), fill=3.0)
    expect_turning(
        system.publish_scans(wall).commands, "In a turn to the right, and now with less room on the right", "right", 0.8
    )
    system.publish_scans(OPEN)
    expect_still(system.publish_scans(OPEN, age=0.9).commands, "With scans that still arrive but are stamped 0.9 s ago")
    system.publish_scans(OPEN)
    start = system.seconds
    system.wait(1.5)
    expect_still(system.messages(start + 1.0).commands, "A second after the last scan")


@check(points=1, covers=("enable", "disabled"), group="step_2", needs=("moves",), doc=contract.SERVICE_DOC)
@hint("self.create_service(SetBool, 'enable', self.enable_callback); the callback returns the response.")
def test_enable(system: System) -> None:
    """Step 2: the service enable holds the robot still or lets it move, and always answers with success true."""
    for data, expect_commands in (
        (False, expect_still),
        (True, lambda commands, situation: expect_driving(commands, situation, 0.3)),
    ):
        response = system.call(SetBool, "/enable", SetBool.Request(data=data))
        expect(response.success, f"Called with data {data}, the service enable answered with success False.")
        expect_commands(system.publish_scans(OPEN).commands, f"After a call of enable with data {data}")


@check(points=1, covers="level", group="step_2", needs=("sees",), doc=contract.NODES_DOC)
@hint("FAILED if any topic is silent; else DEGRADED if the newest clearance is not valid; else OK.")
@hint("Store when each topic was last heard. Only the callback of a timer can notice silence.")
def test_watches(system: System) -> None:
    """Step 2: status_monitor reports OK, DEGRADED with a blocked lidar, and FAILED within 2 s of the lidar's death."""
    for situation, messages, expected in (
        ("With scans", system.publish_scans(OPEN, 2.0), OK),
        ("With nan from every beam ahead", system.publish_scans(scan(Part(-35.0, 35.0, math.nan)), 2.0), DEGRADED),
        ("2 s after the last scan", system.wait(2.0), FAILED),
    ):
        expect(bool(messages.reports), f"{situation}, no report was published on health.")
        level = messages.reports[-1].message.level
        level_name = LEVELS[level] if 0 <= level < len(LEVELS) else level
        expect(level == expected, f"{situation}, health was {level_name} instead of {LEVELS[expected]}.")
    silent, expected_silent = sorted(messages.reports[-1].message.silent), ["clearance", "scan"]
    expect(silent == expected_silent, f"2 s after the last scan, silent was {silent}, instead of {expected_silent}.")
    publishers = system.harness.node.get_publishers_info_by_topic("/health")
    are_durable = [publisher.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for publisher in publishers]
    expect(
        bool(are_durable) and all(are_durable),
        "The durability of health is not transient local: a node that joins late does not get the last report.",
    )


@check(
    points=1,
    covers=("half_angle", "forward_speed", "turn_speed", "safety_distance", "data_timeout", "silence_timeout"),
    group="step_5",
    needs=("starts",),
    doc=contract.PARAMETERS_DOC,
)
@hint("Call declare(self, 'safety_distance', 0.6, 0.3, 2.0, '...') in __init__, and so on for each parameter.")
def test_parameters(system: System) -> None:
    """Step 5: each node declares its parameters with their defaults and ranges."""
    for node, bounds_by_name in PARAMETERS.items():
        node_parameters = system.parameters_of(node)
        missing_sentence = parameters.missing_sentence(bounds_by_name, node_parameters.names())
        expect(not missing_sentence, f"{node}: {missing_sentence}")
        differences = parameters.differences(
            node_parameters.values(*bounds_by_name), {name: bounds.default for name, bounds in bounds_by_name.items()}
        )
        expect(not differences, f"{node}: {'; '.join(differences)}.")
        for name, descriptor in node_parameters.descriptors(*bounds_by_name).items():
            ranges = [(limits.from_value, limits.to_value) for limits in descriptor.floating_point_range]
            bounds = bounds_by_name[name]
            expect(ranges == [(bounds.lowest, bounds.highest)], f"{node}: the range of {name} differs from the table.")


@check(points=1, covers="declares", group="step_5", needs=("parameters", "moves"), doc=contract.PARAMETERS_DOC)
@hint("Read self.get_parameter('forward_speed').value where you create the command. Do not copy it in __init__.")
def test_changed(system: System) -> None:
    """Step 5: a change of forward_speed to 0.12 m/s takes effect immediately, while the system runs."""
    controller = system.parameters_of(CONTROLLER)
    reply = controller.change({"forward_speed": 0.12})
    expect(reply.accepted, f"{CONTROLLER} refused forward_speed = 0.12: {reply.reason}")
    commands = system.publish_scans(OPEN).commands
    controller.change({"forward_speed": 0.3})
    expect_driving(commands, "With forward_speed 0.12", 0.12)
