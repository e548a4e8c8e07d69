"""Numbers of a laser scan, with numpy."""

import numpy as np


def mask_invalid(ranges, range_min, range_max):
    """Return a list of the same length with nan in place of all that is no measurement."""
    values = np.array(ranges, dtype=float)
    with np.errstate(invalid='ignore'):
        kept = np.isinf(values) | ((values >= range_min) & (values <= range_max))
    return np.where(kept, values, np.nan).tolist()


def mean_distance(ranges):
    """Return the mean of what is finite, or None."""
    values = np.array(ranges, dtype=float)
    finite = values[np.isfinite(values)]
    return float(finite.mean()) if finite.size else None


class DataProcessor:
    """A ring of the newest means."""

    def __init__(self, history=100):
        """Make a ring with so many places."""
        self._ring = np.full(history, np.nan)
        self._next = 0

    def process(self, ranges, range_min, range_max):
        """Return the masked ranges, remember their mean."""
        masked = mask_invalid(ranges, range_min, range_max)
        mean = mean_distance(masked)
        if mean is not None:
            self._ring[self._next % len(self._ring)] = mean
            self._next += 1
        return masked

    def average(self):
        """Return the mean of the ring, or None."""
        return mean_distance(self._ring)
