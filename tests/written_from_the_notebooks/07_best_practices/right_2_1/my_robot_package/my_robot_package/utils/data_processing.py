"""Masking and averaging of laser ranges."""

from __future__ import annotations

import math
from statistics import fmean
from typing import Sequence

NOT_MEASURED = float('nan')


def mask_invalid(ranges: Sequence[float], range_min: float, range_max: float) -> list[float]:
    """Copy the ranges; what is neither infinite nor from range_min to range_max is nan."""
    result = []
    for value in ranges:
        value = float(value)
        if value in (math.inf, -math.inf):
            result.append(value)
        elif value >= range_min and value <= range_max:
            result.append(value)
        else:  # a nan comes here, too: no comparison with it holds
            result.append(NOT_MEASURED)
    return result


def mean_distance(ranges: Sequence[float]) -> float | None:
    """Average what is finite, in metres; None if nothing is."""
    finite = list(filter(math.isfinite, ranges))
    if len(finite) == 0:
        return None
    return fmean(finite)


class DataProcessor:
    """Masks scan after scan, and knows the mean of the newest means."""

    def __init__(self, history: int = 100) -> None:
        self.limit = history
        self.history: list[float] = []

    def process(
        self, ranges: Sequence[float], range_min: float, range_max: float,
    ) -> list[float]:
        """Mask one scan, and note its mean unless it has none."""
        masked = mask_invalid(ranges, range_min, range_max)
        mean = mean_distance(masked)
        if mean is None:
            return masked
        self.history.append(mean)
        while len(self.history) > self.limit:
            del self.history[0]
        return masked

    def average(self) -> float | None:
        """Average the noted means, in metres; None before the first."""
        return fmean(self.history) if self.history else None
