"""Computes by brute force what a lidar must measure, written without reference to the engines.

`extended` solves every beam against every wall and circle in numpy's long double; `rational` in fractions, exactly.
Both take the beams' origins and directions as the doubles that the engines use.
"""

from __future__ import annotations

from decimal import Decimal, localcontext
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

Wide = NDArray[np.longdouble]


def extended(
    origin: tuple[float, float],
    directions: NDArray[np.float64],
    segments: NDArray[np.float64],
    circles: NDArray[np.float64],
) -> Wide:
    """The distances (beams,) from `origin` along `directions` (beams, 2) to the nearest wall or disc, inf for none."""
    d = directions.astype(np.longdouble)
    o = np.array(origin, dtype=np.longdouble)
    best = np.full(len(d), np.inf, dtype=np.longdouble)
    for segment in segments.astype(np.longdouble):
        a, b = segment[:2] - o, segment[2:] - o
        # o + r d = a + t (b - a), by Cramer's rule
        e = b - a
        determinant = d[:, 1] * e[0] - d[:, 0] * e[1]
        with np.errstate(divide="ignore", invalid="ignore"):
            r = (a[1] * e[0] - a[0] * e[1]) / determinant
            t = (d[:, 0] * a[1] - d[:, 1] * a[0]) / determinant
        best = np.where((determinant != 0) & (r >= 0) & (t >= 0) & (t <= 1) & (r < best), r, best)
    for x, y, radius in circles.astype(np.longdouble):
        m = o - np.array([x, y])
        # |m + r d|² = R²
        qa, qb, qc = (d * d).sum(axis=1), (d * m).sum(axis=1), m @ m - radius * radius
        if qc <= 0:
            return np.zeros(len(d), dtype=np.longdouble)
        discriminant = qb * qb - qa * qc
        r = (-qb - np.sqrt(np.maximum(discriminant, 0))) / qa
        best = np.where((discriminant >= 0) & (r >= 0) & (r < best), r, best)
    return best


def rational(
    origin: tuple[float, float], direction: tuple[float, float], segments: list[tuple[float, float, float, float]]
) -> Fraction | None:
    """The exact distance along one beam to the nearest of some closed segments, None for a miss."""
    ox, oy = map(Fraction, origin)
    dx, dy = map(Fraction, direction)
    distances = []
    for segment in segments:
        x1, y1, x2, y2 = map(Fraction, segment)
        x1, y1, x2, y2 = x1 - ox, y1 - oy, x2 - ox, y2 - oy
        ex, ey = x2 - x1, y2 - y1
        determinant = dx * ey - dy * ex
        if determinant != 0:
            r = (x1 * ey - y1 * ex) / determinant
            t = (x1 * dy - y1 * dx) / determinant
            if r >= 0 and 0 <= t <= 1:
                distances.append(r)
        elif dx * y1 - dy * x1 == 0 and dx * y2 - dy * x2 == 0:  # the beam runs along the wall, or the wall is a point
            squared = dx * dx + dy * dy
            first, second = (dx * x1 + dy * y1) / squared, (dx * x2 + dy * y2) / squared
            if max(first, second) >= 0:
                distances.append(max(min(first, second), Fraction(0)))
    return min(distances, default=None)


def rational_disc(
    origin: tuple[float, float], direction: tuple[float, float], circle: tuple[float, float, float]
) -> float | None:
    """The distance along one beam to a disc that it starts outside, to sixty digits before it is rounded."""
    cx, cy, radius = map(Fraction, circle)
    mx, my = Fraction(origin[0]) - cx, Fraction(origin[1]) - cy
    dx, dy = map(Fraction, direction)
    a, b, c = dx * dx + dy * dy, dx * mx + dy * my, mx * mx + my * my - radius * radius
    discriminant = b * b - a * c
    if discriminant < 0 or b > 0:
        return None
    with localcontext() as context:
        context.prec = 60
        wide = [Decimal(value.numerator) / Decimal(value.denominator) for value in (a, b, discriminant)]
        return float((-wide[1] - wide[2].sqrt()) / wide[0])
