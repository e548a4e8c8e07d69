"""Utilities that use arrays internally and return lists of plain numbers."""

import numpy as np


def mask_invalid(ranges, range_min, range_max):
    """Return the readings, with nan instead of those that are not measurements."""
    readings = np.array(ranges, dtype=np.float64)
    is_valid = np.isinf(readings) | ((readings >= range_min) & (readings <= range_max))
    return np.where(is_valid, readings, np.nan).tolist()


def mean_distance(ranges):
    """Return the mean of the finite readings as a float, or None."""
    readings = np.fromiter(ranges, dtype=np.float64)
    finite = readings[np.isfinite(readings)]
    return float(finite.mean()) if len(finite) else None


class DataProcessor:
    """A ring buffer of means, whose unused slots contain nan."""

    def __init__(self, history=100):
        """Create an empty ring buffer."""
        self._ring = np.full(history, np.nan)
        self._next = 0

    def process(self, ranges, range_min, range_max):
        """Return the masked readings, and store their mean."""
        masked = mask_invalid(ranges, range_min, range_max)
        mean = mean_distance(masked)
        if mean is not None:
            self._ring[self._next % len(self._ring)] = mean
            self._next += 1
        return masked

    def average(self):
        """Return the mean of the stored means, or None."""
        return mean_distance(self._ring)
