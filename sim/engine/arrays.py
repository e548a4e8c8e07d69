"""The array engine: it computes a scan in about sixty numpy calls, with the same bits as the loops.

The (wall, beam) pairs that meet are put in one flat list, about two for each beam, in which their inverse ranges are
computed and reduced. The scalar code, which is exact, computes the few hard walls: those in line with the sensor, those
that a beam grazes, and those that end so near a beam that rounding could decide.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sim.engine import motion
from sim.engine.exact import ERROR_BOUND
from sim.engine.loops import SMALL, wall_into
from sim.engine.motion import advance_near_obstacles
from sim.engine.pairs import LIMIT, NOTHING, TANGENT, TOUCHING, circle_inverse, wall_hit
from sim.engine.readings import STRENGTH
from sim.engine.shapes import FAR, gap
from sim.engine.trig import TAU, sincos

Floats = NDArray[np.float64]
Float32s = NDArray[np.float32]

__all__ = [
    "advance_near_obstacles",
    "advance_unobstructed",
    "beam_ranges",
    "gap",
    "nearest",
    "scan_ranges",
    "to_readings",
]

# An upper bound, with a wide margin, on the error of numpy's arctan2 and the arithmetic after it, in radians.
BEARING_ERROR = 1e-12
# With more walls than this, it is faster to remove those that are out of reach first.
MAX_WALLS_UNFILTERED = 200
# The beams of a wall are searched for on two laps, because they may continue past the end of a turn.
LAPS = np.array(((0.0,), (1.0,)))


def scan_ranges(
    walls: Floats,
    circles: Floats,
    table: Floats,
    ox: float,
    oy: float,
    yaw: float,
    angle_min: float,
    per_radian: float,
    reach: float,
) -> Floats:
    """Return the ranges of a scan. Arguments and results are those of `loops.scan_ranges`, bit for bit."""
    s, c = sincos(yaw)
    directions = c * table
    dx, dy = directions
    x, y = s * table
    dx -= y
    dy += x
    best = np.empty(table.shape[1])
    best.fill(NOTHING)
    if walls.shape[1] > MAX_WALLS_UNFILTERED:
        x1, x2, y1, y2 = walls[:4]
        is_out_of_reach = (np.maximum(x1, x2) < ox - reach) | (np.minimum(x1, x2) > ox + reach)
        is_out_of_reach |= (np.maximum(y1, y2) < oy - reach) | (np.minimum(y1, y2) > oy + reach)
        walls = walls[:, ~is_out_of_reach]
    if walls.shape[1]:
        _walls_into(best, directions, walls, ox, oy, yaw + angle_min, per_radian, reach)
    if len(circles):
        _circles_into(best, directions, circles, ox, oy)
    np.divide(1.0, best, out=best)
    return best


def _walls_into(
    best: Floats, directions: Floats, walls: Floats, ox: float, oy: float, zero: float, per_radian: float, reach: float
) -> None:
    edge, length = walls[4:6], walls[6]
    ends = walls[:4] - np.array((ox, ox, oy, oy)).reshape(4, 1)  # relative to the sensor
    cross = ends[::2] * edge
    h = cross[0] - cross[1]
    extents = np.abs(ends)
    extents = extents[:2] + extents[2:]
    near = extents[0]
    far = np.minimum(np.maximum(near, extents[1]), reach)
    far += SMALL
    near += far
    near *= far
    near *= length
    is_hard = near >= LIMIT * np.abs(h)

    # Bearings and runs are in turns at first, so that a lap is 1.0.
    count, size = len(best), len(h)
    full = TAU * per_radian
    doubt = BEARING_ERROR / TAU + 1e-12
    bearings = np.arctan2(ends[2:], ends[:2])
    bearings *= 1.0 / TAU
    swing = bearings[1] - bearings[0]
    swing -= np.rint(swing)
    low = np.minimum(swing, 0.0)
    low += bearings[0]
    low -= zero / TAU - doubt
    low -= np.floor(low)
    # On each lap: the number of beams before the run and after it, not yet rounded, with a margin.
    runs = np.empty((2, 2, size))
    beams_before, beams_after = runs
    np.subtract(low, LAPS, out=beams_before)
    np.add(beams_before, np.abs(swing), out=beams_after)
    np.subtract((count - 1) / full + 2.0 * doubt, beams_after, out=beams_after)
    runs *= full
    inner = np.ceil(runs)
    is_unsure = inner - runs > 1.0 - 2.0 * doubt * full

    outside = np.maximum(inner, 0.0).astype(np.intp)  # the numbers of beams before and after the run
    starts = outside[0]
    lengths = count - starts
    lengths -= outside[1]
    np.maximum(lengths, 0, out=lengths)
    suspects = (is_unsure | is_hard).ravel().nonzero()[0]
    if len(suspects):
        for k in {place % size for place in suspects.tolist()}:
            # A hard wall that no beam meets is skipped, unless the sensor may be on it.
            is_met = lengths[0, k] or lengths[1, k] or abs(swing[k]) > 0.4 or h[k] == 0.0
            if is_met or is_unsure[:, :, k].any():
                lengths[:, k] = 0
                px, qx, py, qy, ey, ex, _ = walls[:, k].tolist()
                wall_into(best, directions, ox, oy, (px, py, qx, qy, ex, ey), zero, per_radian)
    h += NOTHING
    factors = np.empty((2, 2, size))  # for x and y; both laps have the same factors
    np.divide(edge[:, None], h, out=factors)
    lengths, shifts = lengths.ravel(), starts.ravel()
    shifts += lengths
    shifts -= lengths.cumsum()
    beams = shifts.repeat(lengths)
    beams += np.arange(len(beams))
    inverse = directions.take(beams, axis=1)
    inverse *= factors.reshape(2, -1).repeat(lengths, axis=1)
    np.maximum.at(best, beams, inverse[0] - inverse[1])


def _circles_into(best: Floats, directions: Floats, circles: Floats, ox: float, oy: float) -> None:
    vx = circles[:, :1] - ox
    vy = circles[:, 1:2] - oy
    radius = circles[:, 2:]
    squared = vx * vx + vy * vy
    dx, dy = directions
    along = dx * vx + dy * vy
    s = dx * vy - dy * vx
    bound = (radius * radius) * (1.001 + TANGENT * squared)
    circle_indices, beams = np.nonzero((s * s <= bound) & (along > -1e-6 * radius))
    if len(circle_indices):
        along, s = along[circle_indices, beams], s[circle_indices, beams]
        radius, squared = radius[circle_indices, 0], squared[circle_indices, 0]
        gap = (radius - s) * (radius + s)
        is_tangent = np.abs(gap) <= TANGENT * (radius * radius) * squared
        is_met_ahead = (gap > 0.0) & (along > 0.0)
        distance = along - np.sqrt(np.where(is_met_ahead, gap, 0.0))
        inverse = np.where(is_met_ahead, 1.0 / np.where(is_met_ahead & (distance > NOTHING), distance, NOTHING), 0.0)
        for at in np.flatnonzero(is_tangent).tolist():
            (cx, cy, r), beam = circles[circle_indices[at]].tolist(), beams[at]
            inverse[at] = circle_inverse(float(dx[beam]), float(dy[beam]), ox, oy, cx, cy, r)
        inverse[squared <= radius * radius] = 0.0
        np.maximum.at(best, beams, inverse)
    if (vx * vx + vy * vy <= circles[:, 2:] * circles[:, 2:]).any():
        best[:] = TOUCHING


def beam_ranges(walls: Floats, circles: Floats, origins: Floats, directions: Floats) -> Floats:
    """Return the ranges of single beams. Arguments and results are those of `traverse.beam_ranges`, bit for bit."""
    best = np.full(len(origins), NOTHING)
    batch = max(1, 200_000 // max(1, walls.shape[1]))
    for at in range(0, len(origins), batch):
        part = slice(at, at + batch)
        _rays_into(best[part], walls, origins[part], directions[part])
    for k in range(len(circles)):
        cx, cy, radius = circles[k].tolist()
        inside = (cx - origins[:, 0]) ** 2 + (cy - origins[:, 1]) ** 2 <= radius * radius
        for beam, (o, d) in enumerate(zip(origins.tolist(), directions.tolist(), strict=True)):
            inverse = TOUCHING if inside[beam] else circle_inverse(d[0], d[1], o[0], o[1], cx, cy, radius)
            best[beam] = max(best[beam], inverse)
    return 1.0 / best


def _rays_into(best: Floats, walls: Floats, origins: Floats, directions: Floats) -> None:
    x1, x2, y1, y2, ey, ex, length = walls
    ox, oy = origins[:, 0:1], origins[:, 1:2]
    dx, dy = directions[:, 0:1], directions[:, 1:2]
    vx, vy = x1 - ox, y1 - oy
    left_term, right_term = dx * vy, dy * vx
    before = left_term - right_term
    is_unsure = np.abs(before) <= ERROR_BOUND * (np.abs(left_term) + np.abs(right_term))
    left_term, right_term = dx * (y2 - oy), dy * (x2 - ox)
    after = left_term - right_term
    is_unsure |= np.abs(after) <= ERROR_BOUND * (np.abs(left_term) + np.abs(right_term))
    left_term, right_term = vx * ey, vy * ex
    h = left_term - right_term
    is_unsure |= np.abs(h) <= 2.0 * ERROR_BOUND * (np.abs(left_term) + np.abs(right_term))
    is_hit = ((before > 0.0) != (after > 0.0)) & ((h > 0.0) == (after > 0.0)) & ~is_unsure
    inverse = dx * (ey / (h + NOTHING)) - dy * (ex / (h + NOTHING))
    m = np.abs(vx) + np.abs(vy)
    is_double_enough = (inverse > 0.0) & (length * (m * inverse + 1.0) <= LIMIT * np.abs(h) * (inverse * inverse))
    np.maximum(best, np.where(is_hit & is_double_enough, inverse, 0.0).max(axis=1, initial=0.0), out=best)
    for beam, k in np.argwhere(is_unsure | (is_hit & ~is_double_enough)).tolist():
        (o_x, o_y), (d_x, d_y) = origins[beam].tolist(), directions[beam].tolist()
        px, qx, py, qy, e_y, e_x, _ = walls[:, k].tolist()
        best[beam] = max(best[beam], wall_hit(d_x, d_y, o_x, o_y, px, py, qx, qy, e_x, e_y))


def nearest(walls: Floats, circles: Floats, x: float, y: float) -> float:
    """Return the distance of (x, y) from the nearest wall or circle, as `shapes.nearest` does."""
    best = FAR
    if walls.shape[1]:
        vx, vy = x - walls[0], y - walls[2]
        ey, ex = walls[4], walls[5]
        squared = ex * ex + ey * ey
        t = np.clip((vx * ex + vy * ey) / np.maximum(squared, NOTHING), 0.0, 1.0)
        vx -= t * ex
        vy -= t * ey
        best = float(np.sqrt((vx * vx + vy * vy).min()))
    for cx, cy, radius in circles.tolist():
        best = min(best, math.hypot(cx - x, cy - y) - radius)
    return best


def to_readings(
    ranges: Floats, noise: Floats, sigma: float, range_min: float, range_max: float, strengths: bool
) -> tuple[Float32s, Float32s]:
    """Convert distances to float32 ranges and intensities, as `readings.to_readings` does."""
    far = ranges > range_max
    if len(noise):
        ranges = ranges + sigma * noise
        far |= ranges > range_max
    ranges[far] = np.inf
    ranges[ranges < range_min] = -np.inf
    result = ranges.astype(np.float32)
    if not strengths:
        return result, result[:0]
    distances = result.astype(np.float64)
    returns = (STRENGTH / (1.0 + distances * distances)).astype(np.float32)
    returns[~(distances >= 0.0)] = 0.0
    return result, returns


def advance_unobstructed(
    robot: Floats, v: float, w: float, ticks: int, dt: float, limits: Floats, drift: Floats, noise: Floats
) -> None:
    """Call `motion.advance_unobstructed` with lists, whose items Python reads faster than those of arrays."""
    numbers: Any = robot.tolist()
    motion.advance_unobstructed(numbers, v, w, ticks, dt, limits.tolist(), drift.tolist(), noise.tolist())
    robot[:] = numbers
