"""Step 2, sensor_processor: the clearance of each scan."""

from __future__ import annotations

import math
import random
from typing import Any

from hypothesis import strategies as st
from rclpy.time import Time
from sensor_msgs.msg import LaserScan

from autograder.checking import LOCKSTEP, Workspace, expect, group, hint
from autograder.checking.drawn_cases import expect_each
from autograder.checks.ch08_capstone.hidden.drawn_scans import (
    OTHER_LIMITS,
    USUAL_LIMITS,
    Arc,
    DrawnScan,
    distance_text,
    distances,
    drawn_scans,
    other_lidars,
    possible_distances,
    readings,
)
from autograder.checks.ch08_capstone.hidden.exact_limits import OPEN, expect_sector_edge, newest_clearance
from autograder.checks.ch08_capstone.hidden.sector_calls import expect_any_sector
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.clearances import MIDDLES
from autograder.checks.ch08_capstone.support.contract import TOLERANCE
from autograder.checks.ch08_capstone.support.system import System

check = group("step_2")

FAST_SCANS, FAST_SECONDS = 5, 0.02  # how many scans, and the seconds between them, of a fast lidar
LATE_SCAN_AGE = 4.0  # s, much more than the delay of a busy machine
FILLS = st.sampled_from((math.nan, math.inf, 3.0))  # m: the reading of all beams that are in no arc
FRAMES = st.integers(100, 999).map(lambda number: f"lidar_{number}")  # unusual names of frames
OTHER_LIDARS = st.sampled_from((USUAL_LIMITS, *OTHER_LIMITS)).flatmap(
    lambda limits: drawn_scans(
        distances(limits) | readings(limits), st.just(limits[1]), other_lidars(), limits, frames=FRAMES
    )
)
# A scan of a wall ahead in which a few beams read nan, and a scan without beams.
WALL = DrawnScan(360, 0.0, 1.0, USUAL_LIMITS, 3.0, (Arc(0, 20, 1.0), Arc(0, 3, math.nan)), "laser", 0.0)
# Scans of one arc ahead, with each reading that has a meaning or is around a limit.
LOWEST, HIGHEST = USUAL_LIMITS
SPECIAL_READINGS = (LOWEST - 0.01, LOWEST, HIGHEST, HIGHEST + 0.01, 0.0, -1.0, math.inf, -math.inf, math.nan)
FROM_ZERO = 0.0, 6.5  # m: the limits of a lidar for which 0 m is a distance
LIMIT_SCANS = tuple(
    DrawnScan(360, 0.0, 1.0, limits, math.nan, (Arc(0, 20, reading),), "laser", 0.0)
    for limits, reading in (*((USUAL_LIMITS, reading) for reading in SPECIAL_READINGS), (FROM_ZERO, 0.0))
)
EMPTY = DrawnScan(0, 0.0, 1.0, USUAL_LIMITS, 3.0, (), "laser", 0.0)


@check(
    points=2,
    covers=("sector", "processor", "clearance-header", "front", "left", "right"),
    needs=("build",),
    after=("processor",),
    doc=contract.SCAN_DOC,
)
@hint("A beam's bearing is angle_min + i * angle_increment, wrapped to (-pi, pi]; left is positive.")
@hint("The middles are 0, pi/2 and -pi/2. A beam belongs to a sector only if it is within half_angle of its middle.")
def test_sectors(processor_system: System, workspace: Workspace, draw: random.Random) -> None:
    """Each scan yields one clearance, with the distances ahead, on the left and on the right, and the scan's header."""
    cases = drawn_scans(distances(), st.just(3.0), ages=st.sampled_from((0.0, LATE_SCAN_AGE)))
    expect_each(
        cases, lambda case: _expect_stamp(processor_system, case), draw, count=_case_count(processor_system, 20)
    )
    start = processor_system.seconds
    processor_system.publish_scans(OPEN, 1.0)
    count = len(processor_system.messages(start).clearances)
    expect(9 <= count <= 11, f"10 scans yielded {count} clearances, instead of 10.", fraction=0.5)
    if processor_system.harness.time == LOCKSTEP:  # in real time, a busy machine may lose some
        start = processor_system.seconds
        for _ in range(FAST_SCANS):
            processor_system.send("/scan", OPEN)
            processor_system.harness.run(FAST_SECONDS)
        count = len(processor_system.messages(start).clearances)
        message = f"{FAST_SCANS} scans, {FAST_SECONDS} s apart, yielded {count} clearances, instead of {FAST_SCANS}."
        expect(count == FAST_SCANS, message, fraction=0.5)
    expect_any_sector(workspace, draw)


@check(
    points=3,
    covers=("readings", "no-reading", "valid-field", "sector", "processor", "clearance-header"),
    needs=("build",),
    after=("sectors",),
    doc=contract.REP_117,
)
@hint("min([nan, 0.5]) is nan: leave nan out first. Finite readings count only from range_min to range_max.")
@hint("min(readings, default=math.nan): the distance is nan if no reading counts, and valid is then false.")
@hint("Take the properties of the lidar from the scan: limits, first bearing, step (it may be negative) and frame.")
def test_readings(processor_system: System, draw: random.Random) -> None:
    """Readings count by REP 117, and a sector in which no reading counts makes the clearance invalid."""
    _expect_distances(processor_system, WALL, WALL.message(), fraction=0.0)
    for limit_scan in LIMIT_SCANS:
        _expect_distances(processor_system, limit_scan, limit_scan.message(), fraction=0.5)
    special_scans = drawn_scans(readings(USUAL_LIMITS), FILLS)
    expect_each(
        special_scans,
        lambda case: _expect_frame(processor_system, case, 0.5),
        draw,
        count=_case_count(processor_system, 50),
    )
    expect_each(
        OTHER_LIDARS,
        lambda case: _expect_frame(processor_system, case, 0.75),
        draw,
        count=_case_count(processor_system, 50),
    )
    _expect_frame(processor_system, EMPTY, 0.75)
    expect_sector_edge(processor_system)


def _case_count(system: System, count: int) -> int:
    """Return how many drawn cases a check can afford: fewer in real time."""
    return count if system.harness.time == LOCKSTEP else 3


def _expect_stamp(system: System, case: DrawnScan) -> None:
    """Fail the check unless a scan's clearance has the correct distances and the scan's stamp."""
    message = case.message()
    clearance = _expect_distances(system, case, message, fraction=0.25)
    scan_stamp, clearance_stamp = (
        Time.from_msg(stamp).nanoseconds / 1e9 for stamp in (message.header.stamp, clearance.header.stamp)
    )
    # In real time, the last scan may not have arrived yet.
    tolerance = 1e-3 if system.harness.time == LOCKSTEP else LATE_SCAN_AGE / 2
    situation = f"A scan arrived {case.age:.0f} s after it was taken"
    expect(
        abs(clearance_stamp - scan_stamp) < tolerance,
        f"{situation}. Its clearance had the stamp {clearance_stamp:.3f} s, instead of the scan's {scan_stamp:.3f} s.",
        fraction=0.5,
    )


def _expect_frame(system: System, case: DrawnScan, fraction: float) -> None:
    """Fail the check unless a scan's clearance has the correct distances and the scan's frame."""
    frame = _expect_distances(system, case, case.message(), fraction).header.frame_id
    message = f"With a scan in the frame {case.frame!r}, the clearance had the frame {frame!r}: copy the scan's header."
    expect(frame == case.frame, message, fraction=0.85)


def _expect_distances(system: System, case: DrawnScan, message: LaserScan, fraction: float) -> Any:
    """Fail the check unless a scan's clearance has the correct distances, and is valid if none is nan; return it."""
    clearance = newest_clearance(system, message, case.age, 0.0 if message.ranges else fraction)
    distance_by_sector = {name: float(getattr(clearance, name)) for name in MIDDLES}
    for name, actual in distance_by_sector.items():
        possible_values = possible_distances(message, MIDDLES[name])
        expected = " or ".join(map(distance_text, possible_values))
        sentence = f"With {case!r}, {name} was {distance_text(actual)}, instead of {expected}."
        expect(any(_is_same(actual, distance) for distance in possible_values), sentence, fraction=fraction)
    is_valid = not any(map(math.isnan, distance_by_sector.values()))
    values = ", ".join(f"{name} {distance_text(distance)}" for name, distance in distance_by_sector.items())
    sentence = f"With {case!r}, the clearance had {values}, but valid was {bool(clearance.valid)}."
    expect(bool(clearance.valid) is is_valid, sentence, fraction=fraction)
    return clearance


def _is_same(distance: float, expected: float) -> bool:
    """Return whether two distances are the same; nan is the same as nan."""
    is_nan = math.isnan(distance) and math.isnan(expected)
    return is_nan or distance == expected or abs(distance - expected) <= TOLERANCE
