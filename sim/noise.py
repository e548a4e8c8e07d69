"""Random numbers that depend on their purpose, and not on the order of the calls.

A stream has a key, made from (seed, robot, sensor), and its blocks are numbered by the tick. numpy's Philox is a
counter-based generator, and numpy guarantees that its raw words do not change. They are converted to normal numbers by
Wichura's rational approximation of the inverse of the normal distribution (algorithm AS 241, 1988). It uses only square
roots, products, sums, and a logarithm that is computed from them, so that every machine draws the same bits.
"""

from __future__ import annotations

import hashlib

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Words = NDArray[np.uint64]

WORDS_PER_BLOCK = 4

_CENTRE_TOP = (
    3.3871328727963666080e0, 1.3314166789178437745e2, 1.9715909503065514427e3, 1.3731693765509461125e4,
    4.5921953931549871457e4, 6.7265770927008700853e4, 3.3430575583588128105e4, 2.5090809287301226727e3,
)  # fmt: skip
_CENTRE_BOTTOM = (
    1.0, 4.2313330701600911252e1, 6.8718700749205790830e2, 5.3941960214247511077e3,
    2.1213794301586595867e4, 3.9307895800092710610e4, 2.8729085735721942674e4, 5.2264952788528545610e3,
)  # fmt: skip
_TAIL_TOP = (
    1.42343711074968357734e0, 4.63033784615654529590e0, 5.76949722146069140550e0, 3.64784832476320460504e0,
    1.27045825245236838258e0, 2.41780725177450611770e-1, 2.27238449892691845833e-2, 7.74545014278341407640e-4,
)  # fmt: skip
_TAIL_BOTTOM = (
    1.0, 2.05319162663775882187e0, 1.67638483018380384940e0, 6.89767334985100004550e-1,
    1.48103976427480074590e-1, 1.51986665636164571966e-2, 5.47593808499534494600e-4, 1.05075007164441684324e-9,
)  # fmt: skip
_FAR_TOP = (
    6.65790464350110377720e0, 5.46378491116411436990e0, 1.78482653991729133580e0, 2.96560571828504891230e-1,
    2.65321895265761230930e-2, 1.24266094738807843860e-3, 2.71155556874348757815e-5, 2.01033439929228813265e-7,
)  # fmt: skip
_FAR_BOTTOM = (
    1.0, 5.99832206555887937690e-1, 1.36929880922735805310e-1, 1.48753612908506148525e-2,
    7.86869131145613259100e-4, 1.84631831751005468180e-5, 1.42151175831644588870e-7, 2.04426310338993978564e-15,
)  # fmt: skip
_LN_2 = 0.6931471805599453
_HALF_ROOT = 0.7071067811865476


def key_of(seed: int, robot: str, sensor: str) -> Words:
    """Return the key (2,) of a stream of random words."""
    digest = hashlib.sha256(f"{seed}/{robot}/{sensor}".encode()).digest()
    return np.frombuffer(digest[:16], dtype="<u8").astype(np.uint64)


def words(key: Words, tick: int, count: int) -> Words:
    """Return `count` random words of 64 bits for one tick. Each tick has 2**64 separate blocks."""
    return words_at(key, [0, tick, 0, 0], count)


def words_at(key: Words, counter: list[int], count: int) -> Words:
    """Return `count` random words of the stream with this key, starting at the position `counter`."""
    raw: Words = np.random.Philox(key=key, counter=counter).random_raw(count)
    return raw


def words_of_ticks(key: Words, tick: int, ticks: int) -> Words:
    """Return (ticks, 4) random words: a block for each tick from `tick` on, the same in one call as in several."""
    raw = words_at(key, [tick, 0, 0, 0], WORDS_PER_BLOCK * ticks)
    return raw.reshape(ticks, WORDS_PER_BLOCK)


def uniform(raw: Words) -> Floats:
    """Return numbers between 0 and 1, both excluded: the centres of 2**52 equal intervals."""
    numbers: Floats = ((raw >> np.uint64(12)).astype(np.float64) + 0.5) * 2.0**-52
    return numbers


def normal(raw: Words) -> Floats:
    """Return standard normal numbers, one for each word."""
    p = uniform(raw)
    q = p - 0.5
    r = 0.180625 - q * q
    result = q * (_horner(_CENTRE_TOP, r) / _horner(_CENTRE_BOTTOM, r))
    is_tail = np.abs(q) > 0.425
    if is_tail.any():
        side = q[is_tail]
        tail_probability = np.where(side < 0.0, p[is_tail], 1.0 - p[is_tail])
        r = np.sqrt(-_log(tail_probability))
        near = r - 1.6
        far = np.maximum(r - 5.0, 0.0)
        tail = np.where(
            r <= 5.0,
            _horner(_TAIL_TOP, near) / _horner(_TAIL_BOTTOM, near),
            _horner(_FAR_TOP, far) / _horner(_FAR_BOTTOM, far),
        )
        result[is_tail] = np.where(side < 0.0, -tail, tail)
    return result


def _horner(coefficients: tuple[float, ...], x: Floats) -> Floats:
    total = np.full_like(x, coefficients[-1])
    for coefficient in coefficients[-2::-1]:
        total *= x
        total += coefficient
    return total


def _log(x: Floats) -> Floats:
    """Return the natural logarithm: log m + k ln 2, and log m = 2 artanh((m - 1) / (m + 1)) as a series."""
    mantissa, k = np.frexp(x)
    small = mantissa < _HALF_ROOT
    m: Floats = np.where(small, 2.0 * mantissa, mantissa)
    t: Floats = (m - 1.0) / (m + 1.0)
    z = t * t
    series = _horner(tuple(1.0 / n for n in range(1, 24, 2)), z)
    return (k - small) * _LN_2 + 2.0 * t * series
