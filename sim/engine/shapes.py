"""The distance of a footprint from walls and circles, and the nearest point.

A body is an array of one or more rows: `[radius, reach]` and, for a polygonal footprint, its corners anticlockwise in
`base_link`. `reach` is the distance of its farthest point from the centre.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from sim.engine.trig import sincos

Floats = NDArray[np.float64]
FAR = 1e300


def nearest_on(px: float, py: float, qx: float, qy: float, x: float, y: float) -> tuple[float, float]:
    """Return the point of the wall p q that is nearest to (x, y)."""
    ex = qx - px
    ey = qy - py
    squared = ex * ex + ey * ey
    if squared == 0.0:
        return px, py
    t = min(max(((x - px) * ex + (y - py) * ey) / squared, 0.0), 1.0)
    if t > 0.5:  # computed from the nearer end, so that both ends are exact
        return qx - (1.0 - t) * ex, qy - (1.0 - t) * ey
    return px + t * ex, py + t * ey


def distance(ax: float, ay: float, bx: float, by: float) -> float:
    """Return the distance between two points, without a library's hypot, whose rounding may differ."""
    x = bx - ax
    y = by - ay
    return math.sqrt(x * x + y * y)


def nearest(walls: Floats, circles: Floats, x: float, y: float) -> float:
    """Return the distance of (x, y) from the nearest wall or circle, in metres; `FAR` if there is none."""
    best = FAR
    for k in range(walls.shape[1]):
        a, b = nearest_on(walls[0, k], walls[2, k], walls[1, k], walls[3, k], x, y)
        best = min(best, (a - x) * (a - x) + (b - y) * (b - y))
    best = math.sqrt(best)
    for k in range(len(circles)):
        best = min(best, distance(circles[k, 0], circles[k, 1], x, y) - circles[k, 2])
    return best


def gap(x: float, y: float, theta: float, body: Floats, walls: Floats, circles: Floats, touch: Floats) -> float:
    """Return the distance in metres from the footprint at a pose to the nearest obstacle, below 0 inside an obstacle.

    The obstacle's number (walls first, then circles), its nearest point, and the direction from this point to the
    footprint are written to `touch` (6,).
    """
    if len(body) > 1:
        return polygon_gap(x, y, theta, body, walls, circles, touch)
    best = FAR
    radius = body[0, 0]
    touch[0] = -1.0
    for k in range(walls.shape[1] + len(circles)):
        if k < walls.shape[1]:
            a, b = nearest_on(walls[0, k], walls[2, k], walls[1, k], walls[3, k], x, y)
            separation = distance(a, b, x, y)
            clearance = separation - radius
        else:
            a, b, r = circles[k - walls.shape[1], 0], circles[k - walls.shape[1], 1], circles[k - walls.shape[1], 2]
            separation = distance(a, b, x, y)
            clearance = separation - radius - r
            if separation > 0.0:
                a, b = a + r * ((x - a) / separation), b + r * ((y - b) / separation)
        if clearance < best:
            best = clearance
            touch[0] = k
            touch[1] = a
            touch[2] = b
            centre_distance = distance(a, b, x, y)
            # Inside a circle, the direction out is also away from its centre.
            sign = -1.0 if k >= walls.shape[1] and clearance + radius < 0.0 else 1.0
            touch[3] = sign * (x - a) / centre_distance if centre_distance > 0.0 else 1.0
            touch[4] = sign * (y - b) / centre_distance if centre_distance > 0.0 else 0.0
    return best


def polygon_gap(x: float, y: float, theta: float, body: Floats, walls: Floats, circles: Floats, touch: Floats) -> float:
    """Return the gap of a convex polygon, and fill `touch`, as `gap` does."""
    s, c = sincos(theta)
    count = len(body) - 1
    corners = np.empty((count + 1, 2))
    for i in range(count):
        corners[i, 0] = x + (c * body[i + 1, 0] - s * body[i + 1, 1])
        corners[i, 1] = y + (s * body[i + 1, 0] + c * body[i + 1, 1])
    corners[count] = corners[0]
    best = FAR
    touch[0] = -1.0
    contact = np.empty(4)
    for k in range(walls.shape[1] + len(circles)):
        if k < walls.shape[1]:
            clearance = polygon_to_wall(corners, walls[0, k], walls[2, k], walls[1, k], walls[3, k], contact)
        else:
            circle = circles[k - walls.shape[1]]
            clearance = polygon_to_point(corners, circle[0], circle[1], contact) - circle[2]
            contact[0] += circle[2] * contact[2]
            contact[1] += circle[2] * contact[3]
        if clearance < best:
            best = clearance
            touch[0] = k
            touch[1:5] = contact
    return best


def polygon_to_point(corners: Floats, px: float, py: float, contact: Floats) -> float:
    """Return the distance of a point from a polygon, below 0 inside. `contact` gets the point and the direction."""
    best = FAR
    inside = True
    contact[0] = px
    contact[1] = py
    contact[2] = 1.0
    contact[3] = 0.0
    for i in range(len(corners) - 1):
        ax, ay, bx, by = corners[i, 0], corners[i, 1], corners[i + 1, 0], corners[i + 1, 1]
        if (bx - ax) * (py - ay) - (by - ay) * (px - ax) < 0.0:
            inside = False
        a, b = nearest_on(ax, ay, bx, by, px, py)
        separation = distance(px, py, a, b)
        if separation < best:
            best = separation
            if separation > 0.0:
                contact[2] = (a - px) / separation
                contact[3] = (b - py) / separation
    if inside:
        contact[2] = -contact[2]
        contact[3] = -contact[3]
        return -best
    return best


def polygon_to_wall(corners: Floats, px: float, py: float, qx: float, qy: float, contact: Floats) -> float:
    """Return the distance of a wall from a convex polygon or, if they overlap, the negative depth of the overlap."""
    # The separating axes are the normals of the polygon and of the wall.
    overlap = FAR
    for i in range(len(corners)):
        if i < len(corners) - 1:
            nx, ny = corners[i + 1, 1] - corners[i, 1], corners[i, 0] - corners[i + 1, 0]
        else:
            nx, ny = qy - py, px - qx
        size = math.sqrt(nx * nx + ny * ny)
        if size > 0.0:
            nx /= size
            ny /= size
            low, high = FAR, -FAR
            for j in range(len(corners) - 1):
                projection = corners[j, 0] * nx + corners[j, 1] * ny
                low = min(low, projection)
                high = max(high, projection)
            first, second = px * nx + py * ny, qx * nx + qy * ny
            forth = high - min(first, second)
            back = max(first, second) - low
            if min(forth, back) < overlap:
                overlap = min(forth, back)
                sign = -1.0 if forth < back else 1.0
                contact[2] = sign * nx
                contact[3] = sign * ny
    if overlap > 0.0:
        contact[0] = 0.5 * (px + qx)
        contact[1] = 0.5 * (py + qy)
        return -overlap
    best = FAR
    for i in range(len(corners) - 1):
        ax, ay, bx, by = corners[i, 0], corners[i, 1], corners[i + 1, 0], corners[i + 1, 1]
        for case in range(3):
            if case == 0:
                a, b = ax, ay
                m, n = nearest_on(px, py, qx, qy, a, b)
            elif case == 1:
                m, n = px, py
                a, b = nearest_on(ax, ay, bx, by, m, n)
            else:
                m, n = qx, qy
                a, b = nearest_on(ax, ay, bx, by, m, n)
            separation = distance(m, n, a, b)
            if separation < best:
                best = separation
                contact[0] = m
                contact[1] = n
                if separation > 0.0:
                    contact[2] = (a - m) / separation
                    contact[3] = (b - n) / separation
    return best
