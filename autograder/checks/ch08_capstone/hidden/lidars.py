"""Step 2: lidars that differ from the usual one, by the arc that they see, by their limits and by their frame."""

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
# Beams 10° apart, the outermost at 125°. Who divides the arc by their number, not by one less, sees those at 35° ahead.
ARC, BEAMS = 125.0, 26
INSIDE = 29.0  # degrees to each side of a middle; half_angle is 29.8°
BETWEEN = 0.4  # m: what is between the sectors is nearer than what is in them
OTHER_LIDARS = 5  # errors that `other_lidar_errors` can name


def other_lidar_errors(system: System, draw: random.Random) -> list[str]:
    """Say what becomes of scans by lidars that differ from the usual one, where it is wrong.

    One sees an arc, to the left or, hung upside down, to the right; another has limits and a frame of its own; others
    begin at any bearing, some turns away too, and go round more than once.
    """
    found = []
    for first in (-ARC, ARC):
        distances = {name: round(draw.uniform(0.7, 2.0), 2) for name in MIDDLES}
        parts = [Part(middle - INSIDE, middle + INSIDE, distances[name]) for name, middle in MIDDLES.items()]
        shown = scan(*parts, fill=BETWEEN, beams=BEAMS, first_bearing=first, last_bearing=-first)
        situation = f"a scan of {BEAMS} beams from {first:.0f}° to {-first:.0f}°"
        found += _wrong_distances(newest_clearance(system, shown), situation, distances)
    lowest, highest = round(draw.uniform(0.4, 0.5), 2), round(draw.uniform(6.0, 9.0), 1)
    distances = {name: round(draw.uniform(4.0, 5.5), 2) for name in MIDDLES}
    walls = [Part(middle - 10.0, middle + 10.0, distances[name]) for name, middle in MIDDLES.items()]
    phantoms = [Part(middle + 15.0, middle + 20.0, lowest / 2) for middle in MIDDLES.values()]
    shown = scan(*walls, *phantoms, fill=math.inf, limits=(lowest, highest))
    shown.header.frame_id = f"lidar_{draw.randrange(100, 1000)}"  # no name that a robot's frame usually has
    situation = f"walls, and a few readings of {lowest / 2:.2f} m, by a lidar for {lowest:.2f} to {highest:.1f} m"
    newest = newest_clearance(system, shown)
    found += _wrong_distances(newest, situation, distances)
    frame, wanted = newest.header.frame_id, shown.header.frame_id
    if frame != wanted:
        found.append(
            f"With scans in the frame {wanted!r}, the clearance's was {frame!r}: its header is the scan's own."
        )
    return found + _far_bearing_errors(system, draw)[:1]


def _far_bearing_errors(system: System, draw: random.Random) -> list[str]:
    """Say what is not seen by lidars that begin anywhere and go round either way, at each bearing that they have."""
    found = []
    for lidar in other_lidars(draw):
        for name, middle in MIDDLES.items():
            bearing, distance = middle + draw.uniform(-25.0, 25.0), round(draw.uniform(0.7, 2.0), 2)
            for seen_at in lidar.sees(bearing):
                shown, wanted = lidar.scan_of_one(seen_at, distance), dict.fromkeys(MIDDLES, 3.0) | {name: distance}
                situation = f"a scan by {lidar} and something at {seen_at:.0f}°, which is {bearing:.0f}°"
                found += _wrong_distances(newest_clearance(system, shown), situation, wanted)
    return found


def _wrong_distances(newest: Any, situation: str, wanted: dict[str, float]) -> list[str]:
    """Say in a sentence which distances of a clearance are wrong, if any is."""
    given = {name: getattr(newest, name) for name in wanted}
    wrong = [
        f"{name} was {given[name]:.2f} instead of {distance:.2f}"
        for name, distance in wanted.items()
        if not abs(given[name] - distance) <= TOLERANCE  # true for nan
    ]
    return [f"With {situation}, {', '.join(wrong)}."] if wrong else []
