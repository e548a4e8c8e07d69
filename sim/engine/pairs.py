"""The range of one beam to one wall or one pillar, which every engine computes with the same operations in one order.

A beam from o along the unit vector d meets a wall from p to q at r = ((p - o) x e) / (d x e), e = q - p. Its inverse is
linear in d: 1/r = dx A - dy B with A = ey / h, B = ex / h and h = (p - o) x e. So the inner loops need no division, and
the nearest wall has the largest inverse, in any order of the walls.

A double is enough unless the beam grazes the wall or the wall is in line with the sensor. The error of r is below about
6 eps (m + r) r |e| / |h|, where m is the distance of p. `LIMIT` keeps it below 1e-12 m. Beyond it, the pair is computed
in double-double arithmetic (`exact.line_distance`). An inverse range of `TOUCHING` represents a range of 0.
"""

from __future__ import annotations

import math

from sim.engine.exact import ERROR_BOUND, circle_distance, line_distance, orientation, side

LIMIT = 1000.0
# A beam counts as nearly tangent to a circle if |R² - s²| is below this share of R² |c - o|².
TANGENT = 1e-6
TOUCHING = 1e300
# The inverse range of a beam that meets nothing. It also keeps quotients finite.
NOTHING = 1e-300


def wall_inverse(
    dx: float,
    dy: float,
    ox: float,
    oy: float,
    px: float,
    py: float,
    qx: float,
    qy: float,
    ex: float,
    ey: float,
) -> float:
    """Return the inverse range of a wall that the beam is known to meet."""
    vx = px - ox
    vy = py - oy
    h = vx * ey - vy * ex
    if h != 0.0:
        inverse = dx * (ey / h) - dy * (ex / h)
        if inverse > 0.0:
            length = abs(ex) + abs(ey)
            m = abs(vx) + abs(vy)
            if length * (m * inverse + 1.0) <= LIMIT * abs(h) * (inverse * inverse):
                return inverse
    distance = line_distance(dx, dy, ox, oy, px, py, qx, qy)
    return 1.0 / distance if distance > NOTHING else TOUCHING


def circle_inverse(dx: float, dy: float, ox: float, oy: float, cx: float, cy: float, radius: float) -> float:
    """Return the inverse range of a circle that does not contain o; 0 if the beam misses it."""
    vx = cx - ox
    vy = cy - oy
    along = dx * vx + dy * vy
    s = dx * vy - dy * vx
    gap = (radius - s) * (radius + s)
    if abs(gap) <= TANGENT * (radius * radius) * (vx * vx + vy * vy):
        distance = circle_distance(dx, dy, ox, oy, cx, cy, radius)
        if distance < 0.0:
            return 0.0
    elif gap > 0.0 and along > 0.0:
        distance = along - math.sqrt(gap)
    else:
        return 0.0
    return 1.0 / distance if distance > NOTHING else TOUCHING


def wall_hit(
    dx: float,
    dy: float,
    ox: float,
    oy: float,
    px: float,
    py: float,
    qx: float,
    qy: float,
    ex: float,
    ey: float,
) -> float:
    """Return the inverse range of a wall, or 0 if the beam misses it. Whether it does is decided exactly."""
    before = side(dx, dy, ox, oy, px, py)
    after = side(dx, dy, ox, oy, qx, qy)
    if before * after > 0:
        return 0.0
    vx = px - ox
    vy = py - oy
    left = vx * ey
    right = vy * ex
    h = left - right
    turn = 1 if h > 0.0 else -1
    if abs(h) <= 2.0 * ERROR_BOUND * (abs(left) + abs(right)):
        turn = orientation(ox, oy, px, py, qx, qy)
    if turn == 0:
        if vx * (qx - ox) + vy * (qy - oy) <= 0.0:
            return TOUCHING  # the sensor is on the wall
        if before != 0 or dx * vx + dy * vy < 0.0:
            return 0.0
    elif turn * before > 0 or turn * after < 0:
        return 0.0
    return wall_inverse(dx, dy, ox, oy, px, py, qx, qy, ex, ey)
