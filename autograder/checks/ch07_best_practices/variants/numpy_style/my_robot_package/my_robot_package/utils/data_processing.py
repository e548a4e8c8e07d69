"""Arrays inside, lists of plain numbers outside."""

import numpy as np


def mask_invalid(ranges, range_min, range_max):
    """Put nan wherever the lidar says nothing."""
    readings = np.array(ranges, dtype=np.float64)
    said = np.isinf(readings) | ((readings >= range_min) & (readings <= range_max))
    return np.where(said, readings, np.nan).tolist()


def mean_distance(ranges):
    """Return the mean of what is finite, as a float, or None."""
    readings = np.fromiter(ranges, dtype=np.float64)
    finite = readings[np.isfinite(readings)]
    return float(finite.mean()) if len(finite) else None


class DataProcessor:
    """A ring of means: a slot that was never filled holds nan."""

    def __init__(self, history=100):
        """Make an empty ring."""
        self._ring = np.full(history, np.nan)
        self._next = 0

    def process(self, ranges, range_min, range_max):
        """Mask one scan, and put its mean into the ring."""
        masked = mask_invalid(ranges, range_min, range_max)
        mean = mean_distance(masked)
        if mean is not None:
            self._ring[self._next % len(self._ring)] = mean
            self._next += 1
        return masked

    def average(self):
        """Return the mean of the filled slots, or None."""
        return mean_distance(self._ring)
