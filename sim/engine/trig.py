"""Sine and cosine, computed only with correctly rounded operations, so that every machine computes the same bits.

The sin and cos of a C library may differ in the last bit between processors with and without fused multiply-add.
Addition, multiplication and flooring of doubles are the same everywhere (IEEE 754), and the functions in this module
use no other operations. They are plain Python, which the compiled engine compiles.
"""

from __future__ import annotations

import math

TWO_OVER_PI = 0.6366197723675814
# pi/2 in three parts. Multiples below 2**20 of the first two are exact (Cody and Waite's reduction).
HALF_PI_1 = 1.5707963267341256
HALF_PI_2 = 6.077100506303966e-11
HALF_PI_3 = 2.0222662487959506e-21

PI = math.pi
TAU = math.tau


def sine(z: float) -> float:
    """Return sin(x)/x for z = x², |x| <= pi/4: Taylor's series, cut where it is below 1e-19."""
    return 1.0 + z * (
        -1.0 / 6.0
        + z
        * (
            1.0 / 120.0
            + z
            * (
                -1.0 / 5040.0
                + z
                * (
                    1.0 / 362880.0
                    + z
                    * (
                        -1.0 / 39916800.0
                        + z * (1.0 / 6227020800.0 + z * (-1.0 / 1307674368000.0 + z * (1.0 / 355687428096000.0)))
                    )
                )
            )
        )
    )


def cosine(z: float) -> float:
    """Return cos(x) for z = x², |x| <= pi/4: Taylor's series, cut where it is below 1e-17."""
    return 1.0 + z * (
        -1.0 / 2.0
        + z
        * (
            1.0 / 24.0
            + z
            * (
                -1.0 / 720.0
                + z
                * (
                    1.0 / 40320.0
                    + z
                    * (-1.0 / 3628800.0 + z * (1.0 / 479001600.0 + z * (-1.0 / 87178291200.0 + z / 20922789888000.0)))
                )
            )
        )
    )


def sincos(angle: float) -> tuple[float, float]:
    """Return the sine and the cosine of `angle` radians, each within 2.3e-16, for |angle| up to 1e5."""
    quadrant = math.floor(angle * TWO_OVER_PI + 0.5)
    x = ((angle - quadrant * HALF_PI_1) - quadrant * HALF_PI_2) - quadrant * HALF_PI_3
    z = x * x
    s = x * sine(z)
    c = cosine(z)
    turn = quadrant % 4
    if turn == 0:
        return s, c
    if turn == 1:
        return c, -s
    if turn == 2:
        return -s, -c
    return -c, s


def sinc(x: float) -> float:
    """Return sin(x)/x, and 1 at 0. It is the ratio of an arc's chord to its length if x is half the turn."""
    if -0.75 < x < 0.75:
        return sine(x * x)
    return sincos(x)[0] / x


def wrap(angle: float) -> float:
    """Return `angle` as the same heading in [-pi, pi)."""
    if -PI <= angle < PI:
        return angle
    wrapped_angle = angle - TAU * math.floor((angle + PI) / TAU)
    return wrapped_angle if wrapped_angle < PI else -PI
