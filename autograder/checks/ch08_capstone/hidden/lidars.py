"""Step 2: lidars that differ from the usual one in their arc, limits or frame."""

from __future__ import annotations

import math
import random
from typing import Any

from autograder.checks.ch02_nodes.support.lidars import other_lidars
from autograder.checks.ch02_nodes.support.scans import Part, scan
from autograder.checks.ch08_capstone.hidden.exact_limits import newest_clearance
from autograder.checks.ch08_capstone.support.contract import TOLERANCE
from autograder.checks.ch08_capstone.support.system import System

MIDDLES = {"front": 0.0, "left": 90.0, "right": -90.0}  # degrees
# Beams are 10° apart, the outermost at 125°. Dividing the arc by their number, instead of one less, moves the beams at
# 35° into the front sector.
ARC, BEAMS = 125.0, 26
HALF_WIDTH = 29.0  # degrees to each side of a middle; half_angle is 29.8°
DISTANCE_BETWEEN = 0.4  # m: things between the sectors are nearer than those in them
MAX_ERRORS = 5  # the most errors that `other_lidar_errors` returns


def other_lidar_errors(system: System, draw: random.Random) -> list[str]:
    """Describe wrong clearances of scans by lidars that differ from the usual one.

    The first two see only an arc, one of them upside down. The third has other limits and another frame. The others
    start at any bearing, also several turns away, and one goes round more than once.
    """
    errors = []
    for first_bearing in (-ARC, ARC):
        distances = {name: round(draw.uniform(0.7, 2.0), 2) for name in MIDDLES}
        parts = [Part(middle - HALF_WIDTH, middle + HALF_WIDTH, distances[name]) for name, middle in MIDDLES.items()]
        published = scan(
            *parts, fill=DISTANCE_BETWEEN, beams=BEAMS, first_bearing=first_bearing, last_bearing=-first_bearing
        )
        situation = f"a scan of {BEAMS} beams from {first_bearing:.0f}° to {-first_bearing:.0f}°"
        errors += _wrong_distances(newest_clearance(system, published), situation, distances)
    range_min, range_max = round(draw.uniform(0.4, 0.5), 2), round(draw.uniform(6.0, 9.0), 1)
    distances = {name: round(draw.uniform(4.0, 5.5), 2) for name in MIDDLES}
    walls = [Part(middle - 10.0, middle + 10.0, distances[name]) for name, middle in MIDDLES.items()]
    phantoms = [Part(middle + 15.0, middle + 20.0, range_min / 2) for middle in MIDDLES.values()]
    published = scan(*walls, *phantoms, fill=math.inf, limits=(range_min, range_max))
    published.header.frame_id = f"lidar_{draw.randrange(100, 1000)}"  # an unusual name for a robot's frame
    situation = (
        f"walls, and a few readings of {range_min / 2:.2f} m, by a lidar for {range_min:.2f} to {range_max:.1f} m"
    )
    newest = newest_clearance(system, published)
    errors += _wrong_distances(newest, situation, distances)
    frame, expected_frame = newest.header.frame_id, published.header.frame_id
    if frame != expected_frame:
        errors.append(
            f"With scans in the frame {expected_frame!r}, the clearance's was {frame!r}: its header is the scan's own."
        )
    return errors + _far_bearing_errors(system, draw)[:1]


def _far_bearing_errors(system: System, draw: random.Random) -> list[str]:
    """Describe wrong distances by lidars that start at any bearing and go round either way."""
    errors = []
    for lidar in other_lidars(draw):
        for name, middle in MIDDLES.items():
            bearing, distance = middle + draw.uniform(-25.0, 25.0), round(draw.uniform(0.7, 2.0), 2)
            for lidar_bearing in lidar.unwrapped_bearings(bearing):
                published, expected = (
                    lidar.scan_of_one(lidar_bearing, distance),
                    dict.fromkeys(MIDDLES, 3.0) | {name: distance},
                )
                situation = f"a scan by {lidar} and something at {lidar_bearing:.0f}°, which is {bearing:.0f}°"
                errors += _wrong_distances(newest_clearance(system, published), situation, expected)
    return errors


def _wrong_distances(newest: Any, situation: str, expected: dict[str, float]) -> list[str]:
    """Describe the wrong distances of a clearance in one sentence, if there are any."""
    actual = {name: getattr(newest, name) for name in expected}
    wrong = [
        f"{name} was {actual[name]:.2f} instead of {distance:.2f}"
        for name, distance in expected.items()
        if not abs(actual[name] - distance) <= TOLERANCE  # True for nan
    ]
    return [f"With {situation}, {', '.join(wrong)}."] if wrong else []
