"""The utilities with numpy inside and plain lists outside."""

import numpy as np


def mask_invalid(ranges, range_min, range_max):
    """Mask by a boolean array."""
    readings = np.array(ranges, dtype=float)
    with np.errstate(invalid="ignore"):
        valid = np.isinf(readings) | ((readings >= range_min) & (readings <= range_max))
    return np.where(valid, readings, np.nan).tolist()


def mean_distance(ranges):
    """Mean by numpy, back as a Python float."""
    readings = np.array(list(ranges), dtype=float)
    finite = readings[np.isfinite(readings)]
    if finite.size == 0:
        return None
    return float(finite.mean())


class DataProcessor:
    """A list that is cut by hand."""

    def __init__(self, history=100):
        """Keep `history` means."""
        self._size = history
        self._means = []

    def process(self, ranges, range_min, range_max):
        """Mask, and remember."""
        masked = mask_invalid(ranges, range_min, range_max)
        mean = mean_distance(masked)
        self._means = [*self._means, *([] if mean is None else [mean])][-self._size :]
        return masked

    def average(self):
        """Return the mean of what is remembered."""
        return sum(self._means) / len(self._means) if self._means else None
