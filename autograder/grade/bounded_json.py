"""Reads JSON from a worker. The values in it are counted before it is parsed."""

from __future__ import annotations

import json
import math
from typing import Any

from autograder.submission.json_size import exceeds

RESULT_VALUES = 100_000  # limit for a result; the results of this course have about 4,000 values
RUN_VALUES = 100_000  # limit for a run that the player shows; each of its columns is packed into one value
NOTEBOOK_VALUES = 500_000  # limit for an executed notebook; for its outputs, the limit is `run_notebook.MAX_VALUES`
_MAX_DIGITS = 100  # digits of an int; with more, it may be impossible to print or to compare with a float


def read_json(data: bytes, limit: int, *, is_strict: bool = True) -> Any:
    """Parse JSON in UTF-8.

    Args:
        data: the JSON.
        limit: the maximum number of commas and brackets outside strings. The number of values is at most one more.
        is_strict: whether NaN, infinity and numbers with too many digits are errors.

    Raises:
        ValueError: `data` is not JSON, or exceeds a limit.
        RecursionError: `data` is nested too deeply.
    """
    text = data.decode()
    # If all keys and values are strings, the text has up to 4 * limit + 4 quotation marks.
    if exceeds(data, limit, 4 * limit + 4):
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
