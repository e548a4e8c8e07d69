"""Utilities for laser scans, with numpy."""

import numpy as np


def mask_invalid(ranges, range_min, range_max):
    """Return the readings, with nan instead of those that are not measurements."""
    values = np.array(ranges, dtype=float)
    with np.errstate(invalid='ignore'):
        is_valid = np.isinf(values) | ((values >= range_min) & (values <= range_max))
    return np.where(is_valid, values, np.nan).tolist()


def mean_distance(ranges):
    """Return the mean of the finite readings, or None."""
    values = np.array(ranges, dtype=float)
    finite = values[np.isfinite(values)]
    return float(finite.mean()) if finite.size else None


class DataProcessor:
    """A ring buffer of the newest means."""

    def __init__(self, history=100):
        """Create a ring buffer for `history` means."""
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
