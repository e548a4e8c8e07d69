"""Step 2, sensor_processor: the clearance of each scan."""

from __future__ import annotations

import math
import random

from rclpy.time import Time

from autograder.checking import LOCKSTEP, CheckFailed, expect, group, hint
from autograder.checks.ch02_nodes.support.scans import RANGE_MAX, Part, scan
from autograder.checks.ch08_capstone.hidden.exact_limits import (
    OPEN,
    empty_scan_errors,
    newest_clearance,
    range_limit_errors,
    sector_edge_errors,
)
from autograder.checks.ch08_capstone.hidden.lidars import MAX_ERRORS, other_lidar_errors
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import TOLERANCE
from autograder.checks.ch08_capstone.support.system import System

check = group("step_2")

LATE = 4.0  # s: the age of a late scan, much more than the delay of a busy machine


@check(
    points=2,
    covers=("sector", "processor", "clearance-header", "front", "left", "right"),
    needs=("build",),
    after=("processor",),
    doc=contract.SCAN_DOC,
)
@hint("A beam's bearing is angle_min + i * angle_increment, wrapped to (-pi, pi]; left is positive.")
@hint("The middles are 0, pi/2 and -pi/2; a beam within half_angle of one belongs to its sector, any other to none.")
def test_sectors(seeing: System, draw: random.Random) -> None:
    """Each scan becomes one clearance: the nearest thing ahead, on the left and on the right, and the scan's header."""
    for beams, first_bearing in ((360, 0.0), (draw.randrange(500, 700), -180.0)):
        distances = {name: round(draw.uniform(0.7, 2.0), 2) for name in ("front", "left", "right")}
        bearings = {"front": draw.uniform(-24, 20), "left": draw.uniform(66, 110), "right": draw.uniform(-114, -70)}
        things = [Part(bearings[name], bearings[name] + 4.0, distance) for name, distance in distances.items()]
        published = scan(
            *things, Part(130.0, 170.0, 0.4), Part(35.0, 55.0, 0.4), beams=beams, first_bearing=first_bearing
        )
        clearances = seeing.publish_scans(published).clearances
        expect(bool(clearances), "No clearance came while scans did.")
        newest = clearances[-1].message
        for name, expected in distances.items():
            actual = getattr(newest, name)
            expect(
                abs(actual - expected) <= TOLERANCE,
                f"With the nearest thing {expected:.2f} m away at {bearings[name] + 2:.0f}°, in a scan that starts at "
                f"{first_bearing:.0f}°, {name} was {actual:.2f}.",
                fraction=0.25,
            )
        expect(bool(newest.valid), "With a reading from every beam, valid was false.", fraction=0.5)
    start = seeing.seconds
    seeing.publish_scans(OPEN, 1.0)
    count = len(seeing.messages(start).clearances)
    expect(9 <= count <= 11, f"10 scans became {count} clearances.", fraction=0.5)
    expect_scan_stamp(seeing)


def expect_scan_stamp(seeing: System) -> None:
    """Fail the check unless the clearance of a late scan has the scan's stamp.

    `test_readings` tests the frame, where a wrong one costs fewer points.
    """
    published = scan()
    clearances = seeing.publish_scans(published, age=LATE).clearances
    expect(bool(clearances), f"No clearance came while scans did whose stamps were {LATE:.0f} s old.", fraction=0.5)
    scan_time, clearance_time = (
        Time.from_msg(published.header.stamp),
        Time.from_msg(clearances[-1].message.header.stamp),
    )
    expect(
        # In real time, the last scan may not have arrived yet.
        abs((clearance_time - scan_time).nanoseconds) < (1e6 if seeing.harness.time == LOCKSTEP else LATE / 2 * 1e9),
        f"With scans that come {LATE:.0f} s after they were taken, the last of them at "
        f"{scan_time.nanoseconds / 1e9:.3f} s, the clearance's stamp was {clearance_time.nanoseconds / 1e9:.3f} s: "
        "its header is the scan's own.",
        fraction=0.5,
    )


@check(
    points=3,
    covers=("readings", "no-reading", "valid-field", "sector", "processor", "clearance-header"),
    needs=("build",),
    after=("sectors",),
    doc=contract.REP_117,
)
@hint("min([nan, 0.5]) is nan: leave nan out first. Finite readings count from range_min to range_max only.")
@hint("min(readings, default=math.nan): a sector without a reading that counts is nan, and valid is false then.")
@hint("The scan says what its lidar is like: its limits, its first bearing, its step (it may be negative), its frame.")
def test_readings(seeing: System, draw: random.Random) -> None:
    """Readings count by REP 117, and a sector without one that counts makes the clearance invalid."""
    bearing, wall = draw.uniform(-20.0, 10.0), draw.uniform(0.8, 1.6)
    few_beams = (bearing, bearing + 4.0)
    cases = (
        ("a few nan beams before a wall", (*few_beams, math.nan), wall),
        ("a few readings of 0.0 before a wall", (*few_beams, 0.0), wall),
        ("a few readings below range_min before a wall", (*few_beams, 0.05), wall),
        ("a few readings above range_max before a wall", (*few_beams, RANGE_MAX + 1.0), wall),
        ("+inf from a few beams before a wall", (*few_beams, math.inf), wall),
        ("-inf from a few beams", (*few_beams, -math.inf), -math.inf),
    )
    errors = []
    for readings, (first, last, reading), expected in cases:
        newest = newest_clearance(seeing, scan(Part(-25.0, 25.0, wall), Part(first, last, reading)))
        if not (newest.valid and (newest.front == expected or abs(newest.front - expected) <= TOLERANCE)):
            errors.append(f"With {readings} at {wall:.2f} m, front was {newest.front:.2f} and valid {newest.valid}.")
    newest = newest_clearance(seeing, scan(Part(-25.0, 25.0, wall), fill=math.inf))
    if not newest.valid:
        errors.append("With a wall ahead, and +inf from every beam on the left and on the right, valid was false.")
    elif not newest.left == newest.right == math.inf:
        sides = f"left was {newest.left:.2f} and right {newest.right:.2f}"
        errors.append(f"With a wall ahead, and +inf from every beam on the left and on the right, {sides}.")
    directions = (("ahead", (-35.0, 35.0)), ("on the left", (55.0, 125.0)), ("on the right", (-125.0, -55.0)))
    invalid_readings = draw.sample((math.nan, 0.0, RANGE_MAX + 1.0), len(directions))
    for (direction, (first, last)), reading in zip(directions, invalid_readings, strict=True):
        newest = newest_clearance(seeing, scan(Part(first, last, reading)))
        if newest.valid:
            errors.append(f"With nothing but {reading:g} {direction}, which does not count, valid was true.")
    near_edges = ((28.0, 1.0), (31.0, 3.0), (-29.0, 1.0), (-32.0, 3.0))  # half_angle is 29.8°
    for first, expected in near_edges:
        front = newest_clearance(seeing, scan(Part(first, first + 1.0, 1.0))).front
        if abs(front - expected) > TOLERANCE:
            errors.append(f"With something 1.00 m away at {first:.0f}° to {first + 1.0:.0f}°, front was {front:.2f}.")
    errors += sector_edge_errors(seeing) + range_limit_errors(seeing) + empty_scan_errors(seeing)
    errors += other_lidar_errors(seeing, draw)
    if errors:
        total = len(cases) + len(directions) + len(near_edges) + 5 + MAX_ERRORS
        raise CheckFailed(" ".join(errors[:2]), fraction=round(max(0.0, 1.0 - len(errors) / total), 2) * 0.9)
