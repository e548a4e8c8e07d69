"""Step 2: the exact limits of sectors, ranges and turns."""

from __future__ import annotations

import math
from typing import Any

from sensor_msgs.msg import LaserScan

from autograder.checking import expect
from autograder.checks.ch02_nodes.support.scans import RANGE_MAX, RANGE_MIN, Part, scan
from autograder.checks.ch08_capstone.support.contract import CONTROLLER, PARAMETERS, PROCESSOR, TOLERANCE
from autograder.checks.ch08_capstone.support.expectations import expect_driving, expect_turning
from autograder.checks.ch08_capstone.support.system import System

SPEED = PARAMETERS[CONTROLLER]["forward_speed"].default
TURN = PARAMETERS[CONTROLLER]["turn_speed"].default
SAFETY_DISTANCE = PARAMETERS[CONTROLLER]["safety_distance"].default
HALF_MARGIN = 0.05  # m, half of the margin beyond the safety distance at which a turn ends
NOT_YET_CLEAR = 0.09  # m beyond the safety distance, slightly less than that margin
# m. EXACT_LIMIT, and the sum of LIMIT_BELOW_EXACT and the margin of 0.1 m, are exact in float32.
EXACT_LIMIT, LIMIT_BELOW_EXACT, EXACT_CLEAR = 0.625, 1.15, 1.25
EXACT_HALVES = (0.1875, 0.3125, 0.5, 0.625)  # rad, each exact in float32
OPEN = scan(fill=math.inf)


def expect_exact_limits(system: System) -> None:
    """Fail the check unless a turn begins and ends exactly at the limits of the contract."""
    limit = f"With a safety distance of {SAFETY_DISTANCE:.2f} m"
    _start_turn(system, SAFETY_DISTANCE - HALF_MARGIN)
    commands = system.publish_scans(_ahead(SAFETY_DISTANCE + NOT_YET_CLEAR)).commands
    expect_turning(
        commands, f"{limit}, in a turn, with {SAFETY_DISTANCE + NOT_YET_CLEAR:.2f} m ahead", "left", TURN, fraction=0.75
    )
    commands = system.publish_scans(_ahead(SAFETY_DISTANCE + 3 * HALF_MARGIN)).commands
    expect_driving(
        commands, f"{limit}, after a turn, with {SAFETY_DISTANCE + 3 * HALF_MARGIN:.2f} m ahead", SPEED, fraction=0.75
    )
    with system.changed_parameter(CONTROLLER, "safety_distance", EXACT_LIMIT):
        commands = system.publish_scans(_ahead(EXACT_LIMIT)).commands
        expect_driving(commands, f"With exactly safety_distance, {EXACT_LIMIT:g} m, ahead", SPEED, fraction=0.75)
    with system.changed_parameter(CONTROLLER, "safety_distance", LIMIT_BELOW_EXACT):
        _start_turn(system, 1.0)
        commands = system.publish_scans(_ahead(EXACT_CLEAR)).commands
        situation = f"With {EXACT_CLEAR:g} m ahead, exactly safety_distance + MARGIN, after a turn"
        expect_driving(commands, situation, SPEED, fraction=0.75)


def sector_edge_errors(system: System) -> list[str]:
    """Describe the error if no beam at exactly half_angle from the middle belongs to its sector.

    One of several is enough, because sine and cosine may add a rounding error.
    """
    is_in_sector = []
    for half_angle in EXACT_HALVES:
        with system.changed_parameter(PROCESSOR, "half_angle", half_angle) as reply:
            if reply.accepted:
                published = scan(fill=3.0, beams=3)
                published.angle_min, published.angle_max = -half_angle, half_angle
                published.angle_increment = half_angle
                published.ranges = [1.0, 3.0, 1.0]
                is_in_sector.append(abs(newest_clearance(system, published).front - 1.0) <= TOLERANCE)
    if any(is_in_sector) or not is_in_sector:
        return []
    situation = f"With something 1.00 m away exactly half_angle ({EXACT_HALVES[-1]:g} rad) from the middle"
    return [f"{situation}, front was 3.00: at most half_angle belongs to the sector."]


def range_limit_errors(system: System) -> list[str]:
    """Describe readings of exactly range_min or range_max that do not count."""
    errors = []
    for name, limit in (("range_min", RANGE_MIN), ("range_max", RANGE_MAX)):
        front = newest_clearance(system, scan(Part(-5.0, 5.0, limit), fill=math.inf)).front
        if abs(front - limit) > TOLERANCE:
            errors.append(f"With readings of exactly {name}, {limit:g} m, ahead, front was {front:.2f}: they count.")
    return errors


def empty_scan_errors(system: System) -> list[str]:
    """Describe the error if a scan without beams gets no clearance, or one with a valid value."""
    published = scan()
    published.ranges = []
    clearances = system.publish_scans(published, 0.5).clearances
    if not clearances:
        return ["Scans without beams became no clearance: each scan becomes one."]
    newest = clearances[-1].message
    is_unknown = not newest.valid and all(map(math.isnan, (newest.front, newest.left, newest.right)))
    return [] if is_unknown else ["With a scan without beams, valid was true or a distance was not nan."]


def newest_clearance(system: System, published: LaserScan) -> Any:
    """Publish a scan for a while; return the last clearance, or fail the check without one."""
    clearances = system.publish_scans(published, 0.5).clearances
    expect(bool(clearances), "No clearance came while scans did.")
    return clearances[-1].message


def _start_turn(system: System, distance: float) -> None:
    system.publish_scans(OPEN)
    system.publish_scans(_ahead(distance))


def _ahead(distance: float) -> LaserScan:
    return scan(Part(-40.0, 40.0, distance))
