"""Step 2: the exact limits of sectors, ranges and turns."""

from __future__ import annotations

import math
from typing import Any

from sensor_msgs.msg import LaserScan

from autograder.checking import LOCKSTEP, expect
from autograder.checks.ch02_nodes.support.scans import Part, scan
from autograder.checks.ch08_capstone.support.contract import CONTROLLER, PARAMETERS, PROCESSOR, TOLERANCE
from autograder.checks.ch08_capstone.support.expectations import expect_driving, expect_turning
from autograder.checks.ch08_capstone.support.system import System

SPEED, TURN_SPEED = (PARAMETERS[CONTROLLER][name].default for name in ("forward_speed", "turn_speed"))
# m. EXACT_LIMIT, and the sum of LIMIT_BELOW_EXACT and the margin of 0.1 m, are exact in float32.
EXACT_LIMIT, LIMIT_BELOW_EXACT, EXACT_CLEAR = 0.625, 1.15, 1.25
NEARLY_CLEAR = EXACT_CLEAR - 0.01  # m
EXACT_HALVES = (0.1875, 0.3125, 0.5, 0.625)  # rad, each exact in float32
OPEN = scan(fill=math.inf)


def expect_exact_limits(system: System) -> None:
    """Fail the check unless a turn begins and ends exactly at the limits of the contract."""
    with system.changed_parameter(CONTROLLER, "safety_distance", EXACT_LIMIT):
        system.publish_scans(OPEN)
        commands = system.publish_scans(_ahead(EXACT_LIMIT)).commands
        expect_driving(commands, f"With exactly safety_distance ({EXACT_LIMIT:g} m) ahead", SPEED, fraction=0.75)
    with system.changed_parameter(CONTROLLER, "safety_distance", LIMIT_BELOW_EXACT):
        system.publish_scans(_ahead(1.0))
        commands = system.publish_scans(_ahead(NEARLY_CLEAR)).commands
        situation = f"During a turn, with less than safety_distance + MARGIN ({NEARLY_CLEAR:g} m) ahead"
        expect_turning(commands, situation, "left", TURN_SPEED, fraction=0.75)
        commands = system.publish_scans(_ahead(EXACT_CLEAR)).commands
        situation = f"During a turn, with exactly safety_distance + MARGIN ({EXACT_CLEAR:g} m) ahead"
        expect_driving(commands, situation, SPEED, fraction=0.75)


def expect_sector_edge(system: System) -> None:
    """Fail the check unless a beam at exactly half_angle from the middle belongs to its sector.

    One of several such beams is enough, because sine and cosine may add a rounding error.
    """
    are_in_sector = []
    for half_angle in EXACT_HALVES:
        with system.changed_parameter(PROCESSOR, "half_angle", half_angle) as reply:
            if reply.accepted:
                scan_message = scan(fill=3.0, beams=3)
                scan_message.angle_min, scan_message.angle_max = -half_angle, half_angle
                scan_message.angle_increment = half_angle
                scan_message.ranges = [1.0, 3.0, 1.0]
                are_in_sector.append(abs(newest_clearance(system, scan_message).front - 1.0) <= TOLERANCE)
    situation = f"With something 1.00 m away exactly half_angle ({EXACT_HALVES[-1]:g} rad) from the middle"
    message = f"{situation}, front was 3.00 m: a beam at half_angle belongs to the sector."
    expect(any(are_in_sector) or not are_in_sector, message, fraction=0.75)


def newest_clearance(system: System, scan_message: LaserScan, age: float = 0.0, fraction: float = 0.0) -> Any:
    """Publish a scan, in real time repeatedly; return the last clearance; fail the check if there is none."""
    start = system.seconds
    system.publish_scan(scan_message, age)
    if system.harness.time != LOCKSTEP or not system.messages(start).clearances:
        system.publish_scans(scan_message, 0.5, age=age)
    clearances = system.messages(start).clearances
    situation = (
        ", although scans were published"
        if scan_message.ranges
        else " for a scan without beams: each scan yields a clearance"
    )
    expect(bool(clearances), f"No clearance was published{situation}.", fraction=fraction)
    return clearances[-1].message


def _ahead(distance: float) -> LaserScan:
    return scan(Part(-40.0, 40.0, distance))
