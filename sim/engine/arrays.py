"""The array engine: a scan in some forty numpy calls, with the same bits as the loops.

The (wall, beam) pairs that meet are laid out in one flat list, about two for each beam, and their inverse ranges are
computed and reduced in it. The few walls that are hard (in line with the sensor, grazed, or ending so near a beam
that rounding could decide) are left to the scalar code, which is exact.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sim.engine import motion
from sim.engine.exact import DOUBT
from sim.engine.loops import SMALL, wall_into
from sim.engine.motion import push
from sim.engine.pairs import LIMIT, NOTHING, TANGENT, TOUCHING, circle_inverse, wall_hit
from sim.engine.readings import STRENGTH
from sim.engine.shapes import FAR, gap
from sim.engine.trig import TAU, sincos

Floats = NDArray[np.float64]
Float32s = NDArray[np.float32]

__all__ = ["coast", "fan", "finish", "gap", "nearest", "push", "rays"]

# How far, in radians, numpy's arctan2 and the arithmetic after it may be off, with a wide margin.
BEARING_ERROR = 1e-12
# Above so many walls it pays to leave out first those that are out of reach.
WORTH_A_LOOK = 200


def fan(
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
    """Return the ranges of a fan: see `loops.fan`, whose arguments and bits these are."""
    s, c = sincos(yaw)
    turned = np.array((((c,), (s,)), ((-s,), (c,)))) * table[:, None]
    directions = turned[0] + turned[1]
    best = np.full(table.shape[1], NOTHING)
    if walls.shape[1] > WORTH_A_LOOK:
        x1, x2, y1, y2 = walls[:4]
        beside = (np.maximum(x1, x2) < ox - reach) | (np.minimum(x1, x2) > ox + reach)
        beside |= (np.maximum(y1, y2) < oy - reach) | (np.minimum(y1, y2) > oy + reach)
        walls = walls[:, ~beside]
    if walls.shape[1]:
        _walls_into(best, directions, walls, ox, oy, yaw + angle_min, per_radian, reach)
    if len(circles):
        _circles_into(best, directions, circles, ox, oy)
    np.divide(1.0, best, out=best)
    return best


def _walls_into(
    best: Floats, directions: Floats, walls: Floats, ox: float, oy: float, zero: float, per_radian: float, reach: float
) -> None:
    size = walls.shape[1]
    ends = np.empty((4, size))  # x of both ends, y of both ends, from the sensor
    np.subtract(walls[:2], ox, out=ends[:2])
    np.subtract(walls[2:4], oy, out=ends[2:])
    edge, length = walls[4:6], walls[6]
    firsts = ends[::2]
    cross = firsts * edge
    h = cross[0] - cross[1]
    apart = np.abs(firsts)
    near = apart[0] + apart[1]
    far = np.minimum(near + length, reach)
    far += SMALL
    near += far
    near *= far
    near *= length
    hard = near >= LIMIT * np.abs(h)

    full = TAU * per_radian
    doubt = BEARING_ERROR * per_radian + 1e-12 * full
    bearings = np.arctan2(ends[2:], ends[:2])
    bearings *= per_radian
    swing = bearings[1] - bearings[0]
    swing -= full * np.rint(swing * (1.0 / full))
    low = np.minimum(swing, 0.0)
    low += bearings[0]
    low -= zero * per_radian
    runs = np.empty((2, 2, size))  # begin and minus end, on the first lap and on the second
    begins = runs[0]
    np.remainder(low, full, out=begins[0])
    np.subtract(begins[0], full, out=begins[1])
    np.add(np.abs(swing), begins, out=runs[1])
    np.negative(runs[1], out=runs[1])
    runs += doubt
    inner = np.ceil(runs)
    unsure = inner - runs > 1.0 - 2.0 * doubt

    starts = np.maximum(inner[0], 0.0)
    counts = np.maximum(inner[1], 1.0 - len(best))  # minus the last beams
    counts += starts
    np.subtract(1.0, counts, out=counts)
    np.maximum(counts, 0.0, out=counts)
    suspects = np.flatnonzero(unsure | hard)
    if len(suspects):
        for k in {place % size for place in suspects.tolist()}:
            # a hard wall that no beam meets is left out, unless the sensor may stand on it
            met = counts[0, k] + counts[1, k] > 0.0 or abs(swing[k]) > 0.4 * full or h[k] == 0.0
            if met or unsure[:, :, k].any():
                counts[:, k] = 0.0
                px, qx, py, qy, ey, ex, _ = walls[:, k].tolist()
                wall_into(best, directions, ox, oy, (px, py, qx, qy, ex, ey), zero, per_radian)
    lengths = counts.astype(np.intp).ravel()
    shifts = starts.astype(np.intp).ravel()
    shifts += lengths
    shifts -= lengths.cumsum()
    pairs = np.repeat(np.arange(2 * size), lengths)
    beams = shifts.take(pairs)
    beams += np.arange(len(pairs))
    inverse = directions.take(beams, axis=1)
    factors = edge / (h + NOTHING)
    inverse *= np.concatenate((factors, factors), axis=1).take(pairs, axis=1)
    np.maximum.at(best, beams, inverse[0] - inverse[1])


def _circles_into(best: Floats, directions: Floats, circles: Floats, ox: float, oy: float) -> None:
    vx = circles[:, :1] - ox
    vy = circles[:, 1:2] - oy
    radius = circles[:, 2:]
    squared = vx * vx + vy * vy
    dx, dy = directions
    along = dx * vx + dy * vy
    s = dx * vy - dy * vx
    most = (radius * radius) * (1.001 + TANGENT * squared)
    which, beams = np.nonzero((s * s <= most) & (along > -1e-6 * radius))
    if len(which):
        along, s = along[which, beams], s[which, beams]
        radius, squared = radius[which, 0], squared[which, 0]
        gap = (radius - s) * (radius + s)
        tangent = np.abs(gap) <= TANGENT * (radius * radius) * squared
        meets = (gap > 0.0) & (along > 0.0)
        distance = along - np.sqrt(np.where(meets, gap, 0.0))
        inverse = np.where(meets, 1.0 / np.where(meets & (distance > NOTHING), distance, NOTHING), 0.0)
        for at in np.flatnonzero(tangent).tolist():
            (cx, cy, r), beam = circles[which[at]].tolist(), beams[at]
            inverse[at] = circle_inverse(float(dx[beam]), float(dy[beam]), ox, oy, cx, cy, r)
        inverse[squared <= radius * radius] = 0.0
        np.maximum.at(best, beams, inverse)
    if (vx * vx + vy * vy <= circles[:, 2:] * circles[:, 2:]).any():
        best[:] = TOUCHING


def rays(walls: Floats, circles: Floats, origins: Floats, directions: Floats) -> Floats:
    """Return the ranges of single beams: see `traverse.rays`, whose arguments and bits these are."""
    best = np.full(len(origins), NOTHING)
    lot = max(1, 200_000 // max(1, walls.shape[1]))
    for at in range(0, len(origins), lot):
        part = slice(at, at + lot)
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
    one, two = dx * vy, dy * vx
    before = one - two
    unsure = np.abs(before) <= DOUBT * (np.abs(one) + np.abs(two))
    one, two = dx * (y2 - oy), dy * (x2 - ox)
    after = one - two
    unsure |= np.abs(after) <= DOUBT * (np.abs(one) + np.abs(two))
    one, two = vx * ey, vy * ex
    h = one - two
    unsure |= np.abs(h) <= 2.0 * DOUBT * (np.abs(one) + np.abs(two))
    hit = ((before > 0.0) != (after > 0.0)) & ((h > 0.0) == (after > 0.0)) & ~unsure
    inverse = dx * (ey / (h + NOTHING)) - dy * (ex / (h + NOTHING))
    m = np.abs(vx) + np.abs(vy)
    plain = (inverse > 0.0) & (length * (m * inverse + 1.0) <= LIMIT * np.abs(h) * (inverse * inverse))
    np.maximum(best, np.where(hit & plain, inverse, 0.0).max(axis=1, initial=0.0), out=best)
    for beam, k in np.argwhere(unsure | (hit & ~plain)).tolist():
        (o_x, o_y), (d_x, d_y) = origins[beam].tolist(), directions[beam].tolist()
        px, qx, py, qy, e_y, e_x, _ = walls[:, k].tolist()
        best[beam] = max(best[beam], wall_hit(d_x, d_y, o_x, o_y, px, py, qx, qy, e_x, e_y))


def nearest(walls: Floats, circles: Floats, x: float, y: float) -> float:
    """Return how far (x, y) is from the nearest wall or circle: see `shapes.nearest`."""
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


def finish(
    ranges: Floats, noise: Floats, sigma: float, range_min: float, range_max: float, strengths: bool
) -> tuple[Float32s, Float32s]:
    """Turn distances into float32 ranges and intensities: see `readings.finish`."""
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


def coast(
    robot: Floats, v: float, w: float, ticks: int, dt: float, limits: Floats, drift: Floats, noise: Floats
) -> None:
    """Advance a robot where nothing is in its way: `motion.coast` on lists, which Python reads faster than arrays."""
    numbers: Any = robot.tolist()
    motion.coast(numbers, v, w, ticks, dt, limits.tolist(), drift.tolist(), noise.tolist())
    robot[:] = numbers
