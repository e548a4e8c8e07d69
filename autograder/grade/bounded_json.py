"""Reads JSON from a worker. Its values are counted before it is parsed."""

from __future__ import annotations

import json
import math
from typing import Any

from autograder.submission.json_size import exceeds

RESULT_VALUES = 100_000  # of a result; those of the course have 4,000
RUN_VALUES = 100_000  # of a run for the player, whose columns are packed
NOTEBOOK_VALUES = 500_000  # of an executed notebook; `run_notebook.MAX_VALUES` limits those of its outputs
_MAX_DIGITS = 100  # of an int: a longer one cannot be compared with a float or printed


def read_json(data: bytes, limit: int, *, is_strict: bool = True) -> Any:
    """Parse JSON in UTF-8.

    Args:
        data: the JSON.
        limit: the maximum number of commas and brackets outside strings. The number of values is at most one more.
        is_strict: whether NaN, infinity and numbers with too many digits are errors.

    Raises:
        ValueError: it is not JSON, or exceeds a bound.
        RecursionError: it is nested too deep.
    """
    text = data.decode()
    if exceeds(
        data, limit, 4 * limit + 4
    ):  # the latter is the number of quotation marks if all keys and values are strings
        raise ValueError(f"it holds more than {limit:,} values")
    if not is_strict:
        return json.loads(text)
    return json.loads(text, parse_int=_int, parse_float=_float, parse_constant=_float)


def _int(digits: str) -> int:
    if len(digits) > _MAX_DIGITS:
        raise ValueError(f"it holds a number of {len(digits)} digits")
    return int(digits)


def _float(digits: str) -> float:
    value = float(digits)
    if not math.isfinite(value):
        raise ValueError(f"it holds the number {digits[:20]}")
    return value
