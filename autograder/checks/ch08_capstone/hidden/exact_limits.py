"""Step 2, to the last digit: where a sector ends, and where a turn begins and ends."""

from __future__ import annotations

import math
from typing import Any

from sensor_msgs.msg import LaserScan

from autograder.checking import expect
from autograder.checks.ch02_nodes.support.scans import RANGE_MAX, RANGE_MIN, Part, scan
from autograder.checks.ch08_capstone.support.contract import CONTROLLER, PARAMETERS, PROCESSOR, TOLERANCE
from autograder.checks.ch08_capstone.support.system import System, expect_driving, expect_turning

SPEED = PARAMETERS[CONTROLLER]["forward_speed"].default
TURN = PARAMETERS[CONTROLLER]["turn_speed"].default
NEAR = PARAMETERS[CONTROLLER]["safety_distance"].default
HALF_MARGIN = 0.05  # m, half of the margin with which a turn ends
NOT_YET_CLEAR = 0.09  # m beyond the safety distance, a little less than that margin
# Safety distances: as a reading exact in a message's float32; exact with the margin of 0.1 m added.
EXACT_LIMIT, LIMIT_BELOW_EXACT, EXACT_CLEAR = 0.625, 1.15, 1.25
EXACT_HALVES = (0.1875, 0.3125, 0.5, 0.625)  # rad, exact in float32
OPEN = scan(fill=math.inf)


def expect_exact_limits(system: System) -> None:
    """Fail the check unless a turn begins and ends where the contract says, to the last digit."""
    limit = f"With a safety distance of {NEAR:.2f} m"
    _turn(system, NEAR - HALF_MARGIN)
    said = system.see(_ahead(NEAR + NOT_YET_CLEAR)).commands
    expect_turning(said, f"{limit}, in a turn, with {NEAR + NOT_YET_CLEAR:.2f} m ahead", "left", TURN, fraction=0.75)
    said = system.see(_ahead(NEAR + 3 * HALF_MARGIN)).commands
    expect_driving(said, f"{limit}, after a turn, with {NEAR + 3 * HALF_MARGIN:.2f} m ahead", SPEED, fraction=0.75)
    with system.changed(CONTROLLER, "safety_distance", EXACT_LIMIT):
        said = system.see(_ahead(EXACT_LIMIT)).commands
        expect_driving(said, f"With exactly safety_distance, {EXACT_LIMIT:g} m, ahead", SPEED, fraction=0.75)
    with system.changed(CONTROLLER, "safety_distance", LIMIT_BELOW_EXACT):
        _turn(system, 1.0)
        said = system.see(_ahead(EXACT_CLEAR)).commands
        situation = f"With {EXACT_CLEAR:g} m ahead, exactly safety_distance + MARGIN, after a turn"
        expect_driving(said, situation, SPEED, fraction=0.75)


def sector_edge_errors(system: System) -> list[str]:
    """Say that no beam that is exactly half_angle from the middle belongs to its sector, if so.

    One of several is enough: who computes with sine and cosine may be off by a rounding.
    """
    tried = []
    for half in EXACT_HALVES:
        with system.changed(PROCESSOR, "half_angle", half) as reply:
            if reply.accepted:
                shown = scan(fill=3.0, beams=3)
                shown.angle_min, shown.angle_increment, shown.angle_max = -half, half, half
                shown.ranges = [1.0, 3.0, 1.0]
                tried.append(abs(newest_clearance(system, shown).front - 1.0) <= TOLERANCE)
    at = f"With something 1.00 m away exactly half_angle ({EXACT_HALVES[-1]:g} rad) from the middle"
    return [] if any(tried) or not tried else [f"{at}, front was 3.00: at most half_angle belongs to the sector."]


def range_limit_errors(system: System) -> list[str]:
    """Say which readings of exactly range_min or range_max do not count, if any."""
    found = []
    for name, limit in (("range_min", RANGE_MIN), ("range_max", RANGE_MAX)):
        front = newest_clearance(system, scan(Part(-5.0, 5.0, limit), fill=math.inf)).front
        if abs(front - limit) > TOLERANCE:
            found.append(f"With readings of exactly {name}, {limit:g} m, ahead, front was {front:.2f}: they count.")
    return found


def empty_scan_errors(system: System) -> list[str]:
    """Say that a scan without beams becomes no clearance, or one that claims to know something, if so."""
    shown = scan()
    shown.ranges = []
    said = system.see(shown, 0.5).clearances
    if not said:
        return ["Scans without beams became no clearance: each scan becomes one."]
    newest = said[-1].message
    unknown = not newest.valid and all(map(math.isnan, (newest.front, newest.left, newest.right)))
    return [] if unknown else ["With a scan without beams, valid was true or a distance was not nan."]


def newest_clearance(system: System, shown: LaserScan) -> Any:
    """Show a scan for a while; return the last clearance, fail the check if none comes."""
    said = system.see(shown, 0.5).clearances
    expect(bool(said), "No clearance came while scans did.")
    return said[-1].message


def _turn(system: System, near: float) -> None:
    system.see(OPEN)
    system.see(_ahead(near))


def _ahead(distance: float) -> LaserScan:
    return scan(Part(-40.0, 40.0, distance))
