"""Step 2, sensor_processor: what becomes of a scan."""

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
from autograder.checks.ch08_capstone.hidden.lidars import OTHER_LIDARS, other_lidar_errors
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import TOLERANCE
from autograder.checks.ch08_capstone.support.system import System

check = group("step_2")

LATE = 4.0  # s: the age of a scan that comes late, much more than a busy machine's delay


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
    for beams, first in ((360, 0.0), (draw.randrange(500, 700), -180.0)):
        distances = {name: round(draw.uniform(0.7, 2.0), 2) for name in ("front", "left", "right")}
        places = {"front": draw.uniform(-24, 20), "left": draw.uniform(66, 110), "right": draw.uniform(-114, -70)}
        parts = [Part(places[name], places[name] + 4.0, distance) for name, distance in distances.items()]
        shown = scan(*parts, Part(130.0, 170.0, 0.4), Part(35.0, 55.0, 0.4), beams=beams, first_bearing=first)
        said = seeing.see(shown).clearances
        expect(bool(said), "No clearance came while scans did.")
        newest = said[-1].message
        for name, wanted in distances.items():
            given = getattr(newest, name)
            expect(
                abs(given - wanted) <= TOLERANCE,
                f"With the nearest thing {wanted:.2f} m away at {places[name] + 2:.0f}°, in a scan that starts at "
                f"{first:.0f}°, {name} was {given:.2f}.",
                fraction=0.25,
            )
        expect(bool(newest.valid), "With a reading from every beam, valid was false.", fraction=0.5)
    began = seeing.seconds
    seeing.see(OPEN, 1.0)
    count = len(seeing.messages(began).clearances)
    expect(9 <= count <= 11, f"10 scans became {count} clearances.", fraction=0.5)
    expect_own_stamp(seeing)


def expect_own_stamp(seeing: System) -> None:
    """Fail the check unless a scan that comes late becomes a clearance with the scan's stamp.

    Whose frame the clearance has is checked with the readings, where less depends on it.
    """
    shown = scan()
    late = seeing.see(shown, age=LATE).clearances
    expect(bool(late), f"No clearance came while scans did whose stamps were {LATE:.0f} s old.", fraction=0.5)
    taken, stamp = Time.from_msg(shown.header.stamp), Time.from_msg(late[-1].message.header.stamp)
    expect(
        # In real time, the last scan may still be on its way.
        abs((stamp - taken).nanoseconds) < (1e6 if seeing.harness.time == LOCKSTEP else LATE / 2 * 1e9),
        f"With scans that come {LATE:.0f} s after they were taken, the last of them at {taken.nanoseconds / 1e9:.3f} s,"
        f" the clearance's stamp was {stamp.nanoseconds / 1e9:.3f} s: its header is the scan's own.",
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
    hole = (bearing, bearing + 4.0)
    cases = (
        ("a few nan beams before a wall", (*hole, math.nan), wall),
        ("a few readings of 0.0 before a wall", (*hole, 0.0), wall),
        ("a few readings below range_min before a wall", (*hole, 0.05), wall),
        ("a few readings above range_max before a wall", (*hole, RANGE_MAX + 1.0), wall),
        ("+inf from a few beams before a wall", (*hole, math.inf), wall),
        ("-inf from a few beams", (*hole, -math.inf), -math.inf),
    )
    wrong = []
    for what, (first, last, reading), wanted in cases:
        newest = newest_clearance(seeing, scan(Part(-25.0, 25.0, wall), Part(first, last, reading)))
        if not (newest.valid and (newest.front == wanted or abs(newest.front - wanted) <= TOLERANCE)):
            wrong.append(f"With {what} at {wall:.2f} m, front was {newest.front:.2f} and valid {newest.valid}.")
    newest = newest_clearance(seeing, scan(Part(-25.0, 25.0, wall), fill=math.inf))
    if not newest.valid:
        wrong.append("With a wall ahead, and +inf from every beam on the left and on the right, valid was false.")
    elif not newest.left == newest.right == math.inf:
        sides = f"left was {newest.left:.2f} and right {newest.right:.2f}"
        wrong.append(f"With a wall ahead, and +inf from every beam on the left and on the right, {sides}.")
    blind = (("ahead", (-35.0, 35.0)), ("on the left", (55.0, 125.0)), ("on the right", (-125.0, -55.0)))
    phantoms = draw.sample((math.nan, 0.0, RANGE_MAX + 1.0), len(blind))
    for (where, (first, last)), reading in zip(blind, phantoms, strict=True):
        newest = newest_clearance(seeing, scan(Part(first, last, reading)))
        if newest.valid:
            wrong.append(f"With nothing but {reading:g} {where}, which does not count, valid was true.")
    edges = ((28.0, 1.0), (31.0, 3.0), (-29.0, 1.0), (-32.0, 3.0))  # half_angle is 29.8°
    for first, wanted in edges:
        front = newest_clearance(seeing, scan(Part(first, first + 1.0, 1.0))).front
        if abs(front - wanted) > TOLERANCE:
            wrong.append(f"With something 1.00 m away at {first:.0f}° to {first + 1.0:.0f}°, front was {front:.2f}.")
    wrong += sector_edge_errors(seeing) + range_limit_errors(seeing) + empty_scan_errors(seeing)
    wrong += other_lidar_errors(seeing, draw)
    if wrong:
        total = len(cases) + len(blind) + len(edges) + 5 + OTHER_LIDARS
        raise CheckFailed(" ".join(wrong[:2]), fraction=round(max(0.0, 1.0 - len(wrong) / total), 2) * 0.9)
