"""Utilities that use numpy internally and return plain lists."""

import numpy as np


def mask_invalid(ranges, range_min, range_max):
    """Return the readings, with nan where a boolean array says invalid."""
    readings = np.array(ranges, dtype=float)
    with np.errstate(invalid="ignore"):
        valid = np.isinf(readings) | ((readings >= range_min) & (readings <= range_max))
    return np.where(valid, readings, np.nan).tolist()


def mean_distance(ranges):
    """Return the mean of the finite readings as a float, or None."""
    readings = np.array(list(ranges), dtype=float)
    finite = readings[np.isfinite(readings)]
    if finite.size == 0:
        return None
    return float(finite.mean())


class DataProcessor:
    """Stores the newest means in a list."""

    def __init__(self, history=100):
        """Store at most `history` means."""
        self._size = history
        self._means = []

    def process(self, ranges, range_min, range_max):
        """Return the masked readings, and store their mean."""
        masked = mask_invalid(ranges, range_min, range_max)
        mean = mean_distance(masked)
        self._means = [*self._means, *([] if mean is None else [mean])][-self._size :]
        return masked

    def average(self):
        """Return the mean of the stored means, or None."""
        return sum(self._means) / len(self._means) if self._means else None
