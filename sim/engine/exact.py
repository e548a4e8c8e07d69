"""Signs and quotients of differences of products, without rounding errors that could matter.

The side of a beam on which a point lies is the sign of a 2 x 2 determinant. Its double precision value has the right
sign unless it is within a few rounding errors of zero. In that case it is summed again exactly, as an expansion (a sum
of doubles that do not overlap). The building blocks are T. J. Dekker's and D. E. Knuth's error-free sums and products.
The scheme of filter and expansion is J. R. Shewchuk's ("Adaptive precision floating-point arithmetic and fast robust
geometric predicates", 1997).

Everything in this module is plain Python on floats, which the fast engine compiles.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

SPLITTER = 134217729.0  # 2**27 + 1
# A determinant of two products of rounded differences is off by less than (3 + 16 eps) eps times the sum of the
# products' sizes, eps = 2**-53 (Shewchuk's ccwerrboundA); one more eps allows for a rounded edge vector.
ERROR_BOUND = 8.9e-16


def two_sum(a: float, b: float) -> tuple[float, float]:
    """Return a + b rounded, and its exact error."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


def two_product(a: float, b: float) -> tuple[float, float]:
    """Return a * b rounded, and its exact error (for results that do not underflow)."""
    product = a * b
    big = SPLITTER * a
    a_high = big - (big - a)
    a_low = a - a_high
    big = SPLITTER * b
    b_high = big - (big - b)
    b_low = b - b_high
    return product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low


def sign_of_sum(terms: NDArray[np.float64]) -> int:
    """Return the exact sign of the sum of `terms`, which are overwritten by the expansion of that sum."""
    size = 0
    for term in terms:
        if term != 0.0:
            carry = term
            for index in range(size):
                carry, terms[index] = two_sum(carry, terms[index])
            terms[size] = carry
            size += 1
    for index in range(size - 1, -1, -1):
        if terms[index] > 0.0:
            return 1
        if terms[index] < 0.0:
            return -1
    return 0


def add_product(
    terms: NDArray[np.float64], at: int, a: float, a_low: float, b: float, b_low: float, sign: float
) -> None:
    """Write the eight exact parts of sign * (a + a_low) * (b + b_low) to `terms`, from index `at` on."""
    terms[at], terms[at + 1] = two_product(sign * a, b)
    terms[at + 2], terms[at + 3] = two_product(sign * a, b_low)
    terms[at + 4], terms[at + 5] = two_product(sign * a_low, b)
    terms[at + 6], terms[at + 7] = two_product(sign * a_low, b_low)


def side(dx: float, dy: float, ox: float, oy: float, px: float, py: float) -> int:
    """Return the exact sign of d x (p - o): 1 if p is left of the ray from o along d, -1 if right, 0 if on its line."""
    left = dx * (py - oy)
    right = dy * (px - ox)
    determinant = left - right
    doubt = ERROR_BOUND * (abs(left) + abs(right))
    if determinant > doubt:
        return 1
    if determinant < -doubt:
        return -1
    x, x_low = two_sum(px, -ox)
    y, y_low = two_sum(py, -oy)
    terms = np.empty(16)
    add_product(terms, 0, dx, 0.0, y, y_low, 1.0)
    add_product(terms, 8, dy, 0.0, x, x_low, -1.0)
    return sign_of_sum(terms)


def orientation(ox: float, oy: float, px: float, py: float, qx: float, qy: float) -> int:
    """Return the exact sign of (p - o) x (q - o): 1 if o, p, q turn left, -1 if right, 0 if they are collinear."""
    ax, ax_low = two_sum(px, -ox)
    ay, ay_low = two_sum(py, -oy)
    bx, bx_low = two_sum(qx, -ox)
    by, by_low = two_sum(qy, -oy)
    terms = np.empty(16)
    add_product(terms, 0, ax, ax_low, by, by_low, 1.0)
    add_product(terms, 8, ay, ay_low, bx, bx_low, -1.0)
    return sign_of_sum(terms)


def double_product(a: float, a_low: float, b: float, b_low: float) -> tuple[float, float]:
    """Return (a + a_low)(b + b_low) as a double-double, with a relative error of about 2**-104."""
    product, error = two_product(a, b)
    error += a * b_low + a_low * b
    return two_sum(product, error)


def double_difference(a: float, a_low: float, b: float, b_low: float) -> tuple[float, float]:
    """Return (a + a_low) - (b + b_low) as a double-double."""
    total, error = two_sum(a, -b)
    low, low_error = two_sum(a_low, -b_low)
    total, error = two_sum(total, error + low)
    return two_sum(total, error + low_error)


def line_distance(dx: float, dy: float, ox: float, oy: float, px: float, py: float, qx: float, qy: float) -> float:
    """Return the distance along d from o at which the ray meets the wall p q, for a ray that is known to meet it.

    It is computed in double-double arithmetic, for beams so nearly parallel to the wall, or walls so nearly in line
    with the sensor, that a double is not enough. r = ((p - o) x e) / (d x e) with e = q - p. The result is clamped to
    the ends of the wall, because rounding could move it beyond them for a beam within 1e-30 of the parallel.
    """
    vx, vx_low = two_sum(px, -ox)
    vy, vy_low = two_sum(py, -oy)
    ex, ex_low = two_sum(qx, -px)
    ey, ey_low = two_sum(qy, -py)
    a, a_low = double_product(vx, vx_low, ey, ey_low)
    b, b_low = double_product(vy, vy_low, ex, ex_low)
    top, top_low = double_difference(a, a_low, b, b_low)
    a, a_low = double_product(dx, 0.0, ey, ey_low)
    b, b_low = double_product(dy, 0.0, ex, ex_low)
    bottom, bottom_low = double_difference(a, a_low, b, b_low)
    first = dx * vx + dy * vy
    second = dx * (qx - ox) + dy * (qy - oy)
    near = max(min(first, second), 0.0)
    far = max(first, second, 0.0)
    if bottom == 0.0:
        return near
    ratio = top / bottom
    product, error = two_product(ratio, bottom)
    ratio += ((top - product) - error + top_low - ratio * bottom_low) / bottom
    return min(max(ratio, near), far)


def circle_distance(dx: float, dy: float, ox: float, oy: float, cx: float, cy: float, radius: float) -> float:
    """Return the distance along d from o, outside the circle, at which the ray meets the circle; -1 if it misses it.

    It is computed in double-double arithmetic, for beams so nearly tangent that a double is not enough. With
    s = d x (c - o) and b = d . (c - o), and |d| = 1 apart from rounding, r = (b - sqrt(|d|² R² - s²)) / |d|².
    """
    vx, vx_low = two_sum(cx, -ox)
    vy, vy_low = two_sum(cy, -oy)
    a, a_low = double_product(dx, 0.0, vy, vy_low)
    b, b_low = double_product(dy, 0.0, vx, vx_low)
    s, s_low = double_difference(a, a_low, b, b_low)
    s, s_low = double_product(s, s_low, s, s_low)
    x, x_low = two_product(dx, dx)
    y, y_low = two_product(dy, dy)
    length, length_low = double_difference(x, x_low, -y, -y_low)
    r, r_low = two_product(radius, radius)
    r, r_low = double_product(r, r_low, length, length_low)
    gap, _ = double_difference(r, r_low, s, s_low)
    along = dx * vx + dy * vy
    if gap < 0.0 or along < 0.0:
        return -1.0
    return (along - math.sqrt(gap)) / length
