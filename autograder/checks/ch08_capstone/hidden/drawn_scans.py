"""Scans from any lidar that the contract allows, and the distances that the contract requires for each scan."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from hypothesis import strategies as st
from sensor_msgs.msg import LaserScan

from autograder.checks.ch02_nodes.support.scans import RANGE_MAX, RANGE_MIN
from autograder.checks.ch08_capstone.support.clearances import HALF_ANGLE, MIDDLES

EDGE_TOLERANCE = math.radians(0.1)  # rad on each side of an edge: less than the difference between 0.52 rad and 30°
USUAL_LIMITS = RANGE_MIN, RANGE_MAX  # m
OTHER_LIMITS = (0.45, 8.25), (0.0, 6.5), (0.12, 0.75)  # m, of lidars for which other readings are phantoms
HALF_ANGLE_DEGREES = math.degrees(HALF_ANGLE)


@dataclass(frozen=True)
class Arc:
    """Adjacent beams with the same reading: the index of the first, how many there are, and the reading in metres."""

    first: int
    beams: int
    reading: float


@dataclass(frozen=True)
class DrawnScan:
    """A scan; bearings are in degrees, readings and limits in metres. A later arc replaces an earlier one.

    Attributes:
        beams: the number of beams.
        first: the unwrapped bearing of beam 0.
        step: the angle from one beam to the next; negative if the lidar turns clockwise.
        limits: `range_min` and `range_max`.
        fill: the reading of all beams that are in no arc.
        arcs: the beams with other readings.
        frame: the lidar's frame.
        age: the age of the scan when it arrives, in seconds.
    """

    beams: int
    first: float
    step: float
    limits: tuple[float, float]
    fill: float
    arcs: tuple[Arc, ...]
    frame: str
    age: float

    def message(self) -> LaserScan:
        """Return the message, with fields that float32 represents exactly; it has no stamp yet."""
        ranges = np.full(self.beams, self.fill, np.float32)
        for arc in self.arcs:
            ranges[arc.first : arc.first + arc.beams] = arc.reading
        start, increment = _float32(math.radians(self.first)), _float32(math.radians(self.step))
        message = LaserScan(angle_min=start, angle_increment=increment, ranges=ranges.tolist())
        # Many drivers count the first direction of a full turn twice.
        message.angle_max = _float32(start + increment * self.beams)
        message.range_min, message.range_max = map(_float32, self.limits)
        message.header.frame_id = self.frame
        return message

    def __repr__(self) -> str:
        if not self.beams:
            return "a scan without beams"
        limits = "" if self.limits == USUAL_LIMITS else f" (range {self.limits[0]:g} to {self.limits[1]:g} m)"
        arcs = [f"{distance_text(arc.reading)} at {self._span(arc.first, arc.beams)}°" for arc in self.arcs]
        fill = distance_text(self.fill) + " everywhere else" * bool(arcs)
        lidar = f"{self.beams} beam{'s' * (self.beams > 1)} from {self._span(0, self.beams)}°{limits}"
        return f"a scan of {lidar} with {', '.join([*arcs, fill])}"

    def _span(self, first: int, beams: int) -> str:
        last = min(first + beams, self.beams) - 1
        low, high = (f"{self.first + self.step * beam:.1f}" for beam in (first, last))
        return low if first == last else f"{low} to {high}"


def possible_distances(message: LaserScan, middle: float) -> set[float]:
    """Return the distances that a sector may have: more than one if beams on the sector's edge matter.

    The requirements: a beam belongs to a sector if it is at most half_angle from the sector's middle, the shorter way
    round, and REP 117 says which readings count. nan means that no reading counts.
    """
    ranges = np.asarray(message.ranges, np.float64)
    bearings = message.angle_min + np.arange(ranges.size) * message.angle_increment
    edge_distances = np.abs(np.remainder(bearings - middle + math.pi, math.tau) - math.pi) - HALF_ANGLE
    is_counted = np.isinf(ranges) | ((ranges >= message.range_min) & (ranges <= message.range_max))
    nearest = min(ranges[is_counted & (edge_distances < -EDGE_TOLERANCE)].tolist(), default=math.nan)
    edge_readings = ranges[is_counted & (np.abs(edge_distances) <= EDGE_TOLERANCE)].tolist()
    return {nearest, *(reading for reading in edge_readings if not reading >= nearest)}


def readings(limits: tuple[float, float]) -> st.SearchStrategy[float]:
    """Draw a reading: one to which REP 117 gives a meaning, one around a limit, or a distance."""
    low, high = limits
    special, lowest = st.sampled_from((math.nan, math.inf, -math.inf)), st.sampled_from((0.0, -1.0, low - 0.01, low))
    return special | lowest | st.sampled_from((high, high + 0.01)) | distances(limits)


def distances(limits: tuple[float, float] = USUAL_LIMITS) -> st.SearchStrategy[float]:
    """Draw a distance that the lidar can measure, to the centimetre."""
    low, high = limits
    return st.integers(math.ceil(low * 100) + 1, math.floor(high * 100) - 1).map(lambda number: number / 100)


@st.composite
def other_lidars(draw: st.DrawFn) -> tuple[int, float, float]:
    """Draw a number of beams, the bearing of beam 0, and the step from one beam to the next, in degrees."""
    beams = draw(st.sampled_from((360, 181, 720)) | st.integers(1, 900))
    first = draw(st.sampled_from((0.0, -90.0, -135.0, -180.0, 90.0, 180.0)) | st.integers(-1080, 1080).map(float))
    span = draw(
        st.sampled_from((180.0, 250.0, 360.0, -360.0, 600.0, -600.0)) | st.integers(-700, 700).filter(bool).map(float)
    )
    return beams, first, span / beams


# Numbers of beams, bearings of beam 0, and steps in degrees.
USUAL_LIDARS = st.sampled_from(((360, 0.0, 1.0), (360, -180.0, 1.0), (600, -180.0, 0.6)))
# Bearings in degrees, around the middles and the edges of the sectors.
BEARINGS = st.builds(
    lambda middle, offset: math.degrees(middle) + offset,
    st.sampled_from([*MIDDLES.values()]),
    st.sampled_from(
        (0, -HALF_ANGLE_DEGREES - 0.5, 0.5 - HALF_ANGLE_DEGREES, HALF_ANGLE_DEGREES - 0.5, HALF_ANGLE_DEGREES + 0.5)
    )
    | st.integers(-45, 45),
)


@st.composite
def drawn_scans(
    draw: st.DrawFn,
    arc_readings: st.SearchStrategy[float],
    fills: st.SearchStrategy[float],
    lidars: st.SearchStrategy[tuple[int, float, float]] = USUAL_LIDARS,
    limits: tuple[float, float] = USUAL_LIMITS,
    frames: st.SearchStrategy[str] = st.just("laser"),  # noqa: B008 - a strategy does not change
    ages: st.SearchStrategy[float] = st.just(0.0),  # noqa: B008
) -> DrawnScan:
    """Draw a scan with up to six arcs, most of them in a sector or at its edges."""
    beams, first, step = draw(lidars)
    arcs = []
    for reading in draw(st.lists(arc_readings, min_size=1, max_size=6)) if beams else ():
        # The beams that look in this direction, or any beam if none does.
        turn = 360.0 / abs(step)
        start = (draw(BEARINGS) - first) / step % turn
        starts = [beam for number in range(3) if (beam := round(start + number * turn)) < beams] or [
            round(start) % beams
        ]
        width = draw(st.sampled_from((1, 4)) | st.integers(1, max(1, beams // 8)))
        arcs.append(Arc(draw(st.sampled_from(starts)), width, reading))
    return DrawnScan(beams, first, step, limits, draw(fills), tuple(arcs), draw(frames), draw(ages))


def distance_text(distance: float) -> str:
    """Return a distance as text."""
    return "nan" if math.isnan(distance) else f"{distance:.3g} m" if math.isfinite(distance) else f"{distance:+}"


def _float32(value: float) -> float:
    return float(np.float32(value))
