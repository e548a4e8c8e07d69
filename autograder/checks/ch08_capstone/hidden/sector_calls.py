"""Step 2: calls of `nearest` for sectors in every direction, including behind the robot."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass
from typing import Any

from autograder.checking import Workspace, expect
from autograder.checking.probes import calls
from autograder.checks.ch08_capstone.hidden.drawn_scans import USUAL_LIMITS, Arc, DrawnScan
from autograder.checks.ch08_capstone.support import clearances
from autograder.checks.ch08_capstone.support.contract import PACKAGE

MODULE = f"{PACKAGE}.sectors"
MIDDLES = (math.pi, -math.pi, 2.8, -2.8, 0.0, 1.2, -1.2)  # rad: the middles of sectors
FIRST_BEARINGS = (0.0, -180.0, 90.0)  # degrees: the bearings of beam 0
OFFSETS = (-1.3, -0.7, 0.7, 1.3)  # from the middle to the wall, in half angles; no beam of the wall is on an edge
FIELDS = ("angle_min", "angle_increment", "range_min", "range_max")
WALL_READING, OTHER_READING = 1.0, 3.0  # m: the readings of the wall, and of all other beams


@dataclass(frozen=True)
class SectorCall:
    """A call of `nearest` with a scan of a wall; angles in radians, the wall's bearing in degrees."""

    scan: DrawnScan
    wall_bearing: float
    middle: float
    half_angle: float

    def __repr__(self) -> str:
        scan = f"a scan from {self.scan.first:.0f}° with a wall {WALL_READING:g} m away at {self.wall_bearing:.0f}°"
        return f"nearest({scan}, middle={self.middle:.2f}, half_angle={self.half_angle:.2f})"


def expect_any_sector(workspace: Workspace, draw: random.Random) -> None:
    """Fail the check unless `nearest` finds a wall within a sector in any direction, and none outside it."""
    sector_calls = [_draw_call(draw, middle, offset) for middle in MIDDLES for offset in OFFSETS]
    plan = calls.Plan()
    results: list[int] = []
    expected = []
    for call in sector_calls:
        message = call.scan.message()
        fields: dict[str, Any] = {name: getattr(message, name) for name in FIELDS}
        scan = plan.add(calls.call("LaserScan", module="sensor_msgs.msg", ranges=list(message.ranges), **fields))
        results.append(plan.add(calls.call("nearest", calls.result_of(scan), call.middle, call.half_angle)))
        expected.append(clearances.nearest(message, call.middle, call.half_angle))
    outcomes = calls.run_steps(workspace, MODULE, *plan.steps)
    for call, result, distance in zip(sector_calls, results, expected, strict=True):
        actual = calls.value(outcomes[result], repr(call))
        expect(calls.same(actual, distance), f"{call!r} returned {actual}, instead of {distance:g}.", fraction=0.75)


def _draw_call(draw: random.Random, middle: float, offset: float) -> SectorCall:
    """Draw a scan with a wall `offset` half angles from the middle of a sector."""
    half_angle, first = draw.uniform(0.3, 0.9), draw.choice(FIRST_BEARINGS)
    wall_bearing = math.degrees(middle + offset * half_angle)
    beam = round(wall_bearing - first) % 360
    return SectorCall(
        DrawnScan(360, first, 1.0, USUAL_LIMITS, OTHER_READING, (Arc(beam, 1, WALL_READING),), "laser", 0.0),
        wall_bearing,
        middle,
        half_angle,
    )
