"""The scalar engine: scans as plain loops, which numba compiles and which the array engine uses for its hard cases.

A scan is measured at one instant. A wall covers one contiguous run of its beams, which is found from the bearings
of the wall's ends. The bearings are approximate, so beams very near an end are decided exactly.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from sim.engine.exact import ERROR_BOUND, orientation, side
from sim.engine.pairs import LIMIT, NOTHING, TOUCHING, circle_inverse, wall_inverse
from sim.engine.trig import PI, TAU, sincos

Floats = NDArray[np.float64]

# The maximum error of `bearing` in radians. Beams within this angle of a wall's end are decided exactly.
BEARING_ERROR = 4e-9
# Makes even the smallest wall a hard case if, apart from rounding, its ends are in line with the sensor.
SMALL = 1e-9


def bearing(x: float, y: float) -> float:
    """Return atan2(y, x) within 2e-9 rad, without branches, by a polynomial fitted to atan at Chebyshev points."""
    ax = abs(x)
    ay = abs(y)
    t = min(ax, ay) / (max(ax, ay) + NOTHING)
    z = t * t
    a = -0.08372063945718174 + z * (
        0.057463557807200256 + z * (-0.030717508861835746 + z * (0.010680719422539797 + z * -0.0017437011383732673))
    )
    a = t * (
        0.9999999975460201
        + z
        * (
            -0.33333282295510885
            + z * (0.19998230640360679 + z * (-0.14261573680139644 + z * (0.10940198964371045 + z * a)))
        )
    )
    a = 0.5 * PI - a if ay > ax else a
    a = PI - a if x < 0.0 else a
    return -a if y < 0.0 else a


def wall_into(
    best: Floats,
    directions: Floats,
    ox: float,
    oy: float,
    wall: tuple[float, float, float, float, float, float],
    zero: float,
    per_radian: float,
) -> None:
    """Raise the inverse ranges `best` (beams,) to those of a wall where it is nearer. Each beam is decided exactly.

    `directions` is (2, beams), `zero` the bearing of the first beam in the map, and `per_radian` the beams per radian.
    """
    px, py, qx, qy, ex, ey = wall
    vx = px - ox
    vy = py - oy
    wx = qx - ox
    wy = qy - oy
    left = vx * ey
    right = vy * ex
    h = left - right
    turn = 1 if h > 0.0 else -1
    if abs(h) <= 2.0 * ERROR_BOUND * (abs(left) + abs(right)):
        turn = orientation(ox, oy, px, py, qx, qy)
    if turn == 0 and vx * wx + vy * wy <= 0.0:
        best[:] = TOUCHING  # the sensor is on the wall
        return
    begin = bearing(vx, vy)
    end = bearing(wx, wy)
    if turn < 0:
        begin, end = end, begin
    full = TAU * per_radian
    first = (begin - zero) * per_radian
    first -= full * math.floor(first / full)
    width = (end - begin) * per_radian
    width -= full * math.floor(width / full + 0.25)  # from -1/4 to 3/4 of a turn: a wall covers at most half a turn
    doubt = BEARING_ERROR * per_radian + 1e-12 * full
    count = best.shape[0]
    for lap in range(2):
        low = first - lap * full
        high = low + width
        for beam in range(max(math.ceil(low - doubt), 0), min(math.floor(high + doubt), count - 1) + 1):
            dx = directions[0, beam]
            dy = directions[1, beam]
            if beam < low + doubt or beam > high - doubt:
                before = side(dx, dy, ox, oy, px, py)
                after = side(dx, dy, ox, oy, qx, qy)
                if turn * before > 0 or turn * after < 0:
                    continue
                if turn == 0 and (before != 0 or dx * vx + dy * vy < 0.0):
                    continue
            best[beam] = max(best[beam], wall_inverse(dx, dy, ox, oy, px, py, qx, qy, ex, ey))


def circle_into(
    best: Floats,
    directions: Floats,
    ox: float,
    oy: float,
    circle: tuple[float, float, float],
    zero: float,
    per_radian: float,
) -> None:
    """Raise the inverse ranges `best` (beams,) to those of a solid circle where the circle is nearer."""
    cx, cy, radius = circle
    vx = cx - ox
    vy = cy - oy
    squared = vx * vx + vy * vy
    if squared <= radius * radius:
        best[:] = TOUCHING
        return
    full = TAU * per_radian
    # asin(t) <= pi/2 t, so the run may contain a few beams that miss the circle.
    half = 0.5 * PI * (radius / math.sqrt(squared)) * per_radian + 1.0
    middle = (bearing(vx, vy) - zero) * per_radian
    middle -= full * math.floor(middle / full)
    for lap in range(-1, 2):
        low = max(math.ceil(middle - half + lap * full), 0)
        high = min(math.floor(middle + half + lap * full), best.shape[0] - 1)
        for beam in range(low, high + 1):
            inverse = circle_inverse(directions[0, beam], directions[1, beam], ox, oy, cx, cy, radius)
            best[beam] = max(best[beam], inverse)


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
    """Return the ranges (beams,) of a scan at (ox, oy) with the heading `yaw`, in metres, valid up to `reach`.

    `walls` is (7, N): x1, x2, y1, y2, y2 - y1, x2 - x1 and the sum of the absolute values of the last two.
    `circles` is (M, 3). `table` is (2, beams): the beams' directions in the sensor's frame.
    """
    s, c = sincos(yaw)
    zero = yaw + angle_min
    count = table.shape[1]
    directions = np.empty((2, count))
    best = np.empty(count)
    for beam in range(count):
        directions[0, beam] = c * table[0, beam] - s * table[1, beam]
        directions[1, beam] = s * table[0, beam] + c * table[1, beam]
        best[beam] = NOTHING
    size = walls.shape[1]
    full = TAU * per_radian
    doubt = BEARING_ERROR * per_radian + 1e-12 * full
    plan = np.empty((5, size))
    for k in range(size):  # without branches, so that it is compiled to vector instructions
        vx = walls[0, k] - ox
        wx = walls[1, k] - ox
        vy = walls[2, k] - oy
        wy = walls[3, k] - oy
        ey = walls[4, k]
        ex = walls[5, k]
        h = vx * ey - vy * ex
        begin = bearing(vx, vy)
        end = bearing(wx, wy)
        swap = h < 0.0
        low = end if swap else begin
        high = begin if swap else end
        first = (low - zero) * per_radian
        first -= full * np.floor(first / full)
        width = (high - low) * per_radian
        width -= full * np.floor(width / full + 0.25)
        near = abs(vx) + abs(vy)
        far = min(near + walls[6, k], reach) + SMALL
        plan[0, k] = first
        plan[1, k] = width
        plan[2, k] = ey / (h + NOTHING)
        plan[3, k] = ex / (h + NOTHING)
        plan[4, k] = 1.0 if walls[6, k] * (near + far) * far >= LIMIT * abs(h) else 0.0
    for k in range(size):
        first = plan[0, k]
        width = plan[1, k]
        a = plan[2, k]
        b = plan[3, k]
        is_hard = plan[4, k] != 0.0
        for lap in range(2):
            low = first - lap * full
            high = low + width
            start = math.ceil(low + doubt)
            stop = math.floor(high - doubt)
            is_hard = is_hard or math.ceil(low - doubt) != start or math.floor(high + doubt) != stop
        if is_hard:
            wall = (walls[0, k], walls[2, k], walls[1, k], walls[3, k], walls[5, k], walls[4, k])
            wall_into(best, directions, ox, oy, wall, zero, per_radian)
            continue
        for lap in range(2):
            low = first - lap * full
            for beam in range(max(math.ceil(low), 0), min(math.floor(low + width), count - 1) + 1):
                inverse = directions[0, beam] * a - directions[1, beam] * b
                best[beam] = inverse if inverse > best[beam] else best[beam]
    for k in range(circles.shape[0]):
        circle_into(best, directions, ox, oy, (circles[k, 0], circles[k, 1], circles[k, 2]), zero, per_radian)
    for beam in range(count):
        best[beam] = 1.0 / best[beam]
    return best
