"""Reads JSON that a worker left: its values are counted first, as three bytes can take sixty in memory."""

from __future__ import annotations

import json
import math
from typing import Any

RESULT_VALUES = 100_000  # of a result; those of the course have 4,000
RUN_VALUES = 100_000  # of a run for the player, whose columns are packed
NOTEBOOK_VALUES = 500_000  # of an executed notebook; `run_notebook.MAX_VALUES` bounds those of its outputs
_MAX_DIGITS = 100  # of an int: a longer one can be neither compared with a float nor shown


def read_json(data: bytes, most: int, *, is_strict: bool = True) -> Any:
    """Return what JSON in UTF-8 stands for.

    Args:
        data: the JSON.
        most: of commas and brackets outside of its strings. There are at least as many of them as values, but for one.
        is_strict: whether a number that cannot be computed with or shown is an error: NaN, infinity, endless digits.

    Raises:
        ValueError: it is no JSON, or breaks a bound.
        RecursionError: it is nested too deep.
    """
    text = data.decode()
    if _marks(data, most) > most:
        raise ValueError(f"it holds more than {most:,} values")
    if not is_strict:
        return json.loads(text)
    return json.loads(text, parse_int=_int, parse_float=_float, parse_constant=_float)


def _marks(data: bytes, most: int) -> int:
    """Count commas and brackets outside of strings; its steps and its memory grow with the length of the data."""
    unescaped = data.replace(rb"\\", b"").replace(rb"\"", b"")
    if unescaped.count(b'"') > 4 * most + 4:  # as many have keys and values, if all of them are strings
        return most + 1
    outside = b"".join(unescaped.split(b'"')[::2])
    return sum(map(outside.count, (b",", b"[", b"{")))


def _int(digits: str) -> int:
    if len(digits) > _MAX_DIGITS:
        raise ValueError(f"it holds a number of {len(digits)} digits")
    return int(digits)


def _float(digits: str) -> float:
    value = float(digits)
    if not math.isfinite(value):
        raise ValueError(f"it holds the number {digits[:20]}")
    return value
