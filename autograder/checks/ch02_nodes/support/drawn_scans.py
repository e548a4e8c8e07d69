"""Scans from any lidar that the contract allows, and the reading on which the reaction to each scan depends."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray
from sensor_msgs.msg import LaserScan

from autograder.checks.ch02_nodes.support.contract import HALF_SECTOR, SAFETY_DISTANCE
from autograder.checks.ch02_nodes.support.scans import RANGE_MAX, RANGE_MIN

# Degrees around the sector's edge, where a beam may count or not. Another check tests the width of the sector, with
# scans that are not drawn.
EDGE = 3.5
MIN_WIDTH = 3  # beams of an arc, for a robot that ignores a single beam
# Lidars that see some directions more than once: their numbers of beams, bearings of beam 0, and steps in degrees.
SEVERAL_TURNS = st.tuples(
    st.sampled_from((720, 721, 1081)), st.sampled_from((0.0, -180.0, 95.0, -620.0)), st.sampled_from((1.0, -1.0))
)
PHANTOMS = (0.0, -1.0)  # m: finite readings that no lidar can measure


@dataclass(frozen=True)
class Arc:
    """Neighbouring beams with the same reading: the number of the first one, their count, and the reading in metres."""

    first: int
    beams: int
    reading: float


@dataclass(frozen=True)
class DrawnScan:
    """A scan: bearings in degrees, readings and limits in metres. A later arc replaces an earlier one.

    Attributes:
        beams: the number of beams.
        first: the unwrapped bearing of beam 0.
        step: the angle from one beam to the next; negative if the lidar turns clockwise.
        limits: `range_min` and `range_max`.
        fill: the reading of all beams that are in no arc.
        arcs: the beams with other readings.
        overshoot: how many steps `angle_max` is beyond the last beam. Many drivers count one direction of a full turn
            twice.
    """

    beams: int
    first: float
    step: float
    limits: tuple[float, float]
    fill: float
    arcs: tuple[Arc, ...]
    overshoot: int = 0

    def message(self) -> LaserScan:
        """Return the message, with fields that float32 represents exactly."""
        ranges = np.full(self.beams, self.fill, np.float32)
        for arc in self.arcs:
            ranges[arc.first : arc.first + arc.beams] = arc.reading
        start, increment = _float32(math.radians(self.first)), _float32(math.radians(self.step))
        message = LaserScan(angle_min=start, angle_increment=increment, scan_time=_float32(0.1))
        message.header.frame_id = "laser"
        message.angle_max = _float32(start + increment * (self.beams - 1 + self.overshoot))
        message.range_min, message.range_max = map(_float32, self.limits)
        message.ranges = ranges.tolist()
        return message

    def __repr__(self) -> str:
        last = self.first + self.step * (self.beams - 1)
        lidar = f"a lidar of {self.beams} beam{'s' * (self.beams > 1)} from {self.first:.1f}° to {last:.1f}°"
        lidar += ", whose angle_max is one step beyond the last beam" * self.overshoot
        limits = "" if self.limits == (RANGE_MIN, RANGE_MAX) else f", whose range is {_span(*self.limits)} m"
        arcs = [
            f"{arc.reading:.3g} m at {_span(self.first + arc.first * self.step, self._last_bearing(arc))}°"
            for arc in self.arcs
        ]
        elsewhere = f"{self.fill:g} m{' everywhere else' * bool(arcs)}"
        return f"{lidar}{limits}, and readings of {', '.join([*arcs, elsewhere])}"

    def _last_bearing(self, arc: Arc) -> float:
        return self.first + (min(arc.first + arc.beams, self.beams) - 1) * self.step


def nearest_ahead(message: LaserScan) -> set[float | None]:
    """Return the smallest forward reading that counts, for each choice of beams on the sector's edges.

    By the contract, bearings wrap around, the forward sector extends 30 degrees to each side, and REP 117 says which
    readings count. None means that no reading counts. Minus infinity means that something is too near to measure.
    """
    ranges = np.asarray(message.ranges)
    unwrapped_bearings = message.angle_min + np.arange(len(ranges)) * message.angle_increment
    degrees = np.degrees(np.remainder(unwrapped_bearings + math.pi, math.tau) - math.pi)
    is_valid = np.isinf(ranges) | ((ranges >= message.range_min) & (ranges <= message.range_max))
    is_inside = is_valid & (np.abs(degrees) < HALF_SECTOR - EDGE)
    is_on_edge = is_valid & ~is_inside & (np.abs(degrees) <= HALF_SECTOR + EDGE)
    nearest = _smallest(ranges[is_inside])
    edge_readings = map(float, ranges[is_on_edge])
    return {nearest, *(reading for reading in edge_readings if nearest is None or reading < nearest)}


def is_near(distance: float) -> bool:
    """Return whether something at this distance ahead blocks the way."""
    return distance < SAFETY_DISTANCE


@st.composite
def any_lidars(draw: st.DrawFn) -> tuple[int, float, float]:
    """Draw a number of beams, the bearing of beam 0, and the step from one beam to the next, in degrees."""
    beams = draw(st.sampled_from((360, 181, 720)) | st.integers(1, 1500))
    first = draw(st.sampled_from((0.0, -90.0, -135.0, -180.0, 90.0, 180.0)) | st.integers(-1080, 1080).map(float))
    span = draw(st.sampled_from((180.0, 270.0, 360.0, -360.0, 600.0)) | st.integers(-700, 700).filter(bool).map(float))
    return beams, first, span / beams


@st.composite
def drawn_scans(
    draw: st.DrawFn,
    readings: st.SearchStrategy[float],
    fills: st.SearchStrategy[float],
    *,
    lidars: st.SearchStrategy[tuple[int, float, float]] = any_lidars(),  # noqa: B008 - a strategy does not change
    limits: tuple[float, float] = (RANGE_MIN, RANGE_MAX),
) -> DrawnScan:
    """Draw a scan with up to three arcs of these readings, most of which are ahead or to the sides."""
    beams, first, step = draw(lidars)
    arcs = []
    for reading in draw(st.lists(readings, max_size=3)):
        bearing = draw(st.integers(-45, 45) | st.integers(-180, 180))
        # The numbers of the beams that look in this direction: one for each turn of the lidar.
        turn = 360.0 / abs(step)
        start = (bearing - first) / step % turn
        starts = [round(start + number * turn) for number in range(3) if start + number * turn < beams]
        width = draw(st.integers(MIN_WIDTH, max(MIN_WIDTH, beams // 8)))
        last = starts[-1] if starts else beams - 1  # the beam in the last turn, or else the lidar's last beam
        arcs.append(Arc(draw(st.sampled_from([*starts, last])), width, reading))
    return DrawnScan(beams, first, step, limits, draw(fills), tuple(arcs), draw(st.integers(0, 1)))


@st.composite
def scans_ahead(
    draw: st.DrawFn,
    readings: st.SearchStrategy[float],
    fills: st.SearchStrategy[float],
    *,
    limits: tuple[float, float] = (RANGE_MIN, RANGE_MAX),
) -> DrawnScan:
    """Draw a scan with these readings straight ahead, for checks of readings.

    A robot that computes bearings or the sector's width incorrectly still reacts to it as a correct robot does.
    """
    arcs = [Arc(0, draw(st.integers(8, 12)), draw(readings))]
    if draw(st.booleans()):
        arcs.append(Arc(draw(st.integers(0, 5)), MIN_WIDTH, draw(readings)))
    return DrawnScan(360, 0.0, 1.0, limits, draw(fills), tuple(arcs))


def _smallest(readings: NDArray[np.float64]) -> float | None:
    return float(readings.min()) if readings.size else None


def _float32(value: float) -> float:
    return float(np.float32(value))


def _span(low: float, high: float) -> str:
    return f"{low:.4g}" if low == high else f"{low:.4g} to {high:.4g}"
