"""Utilities with plain loops."""

from collections import deque
from math import isfinite, isnan, nan


def mask_invalid(ranges, range_min, range_max):
    """Return the readings, with nan instead of those that are not measurements."""
    masked = []
    for reading in ranges:
        if isnan(reading):
            masked.append(nan)
        elif not isfinite(reading):
            masked.append(reading)
        elif reading < range_min or reading > range_max:
            masked.append(nan)
        else:
            masked.append(reading)
    return masked


def mean_distance(ranges):
    """Return the mean of the finite readings, or None."""
    count, total = 0, 0.0
    for reading in filter(isfinite, ranges):
        count += 1
        total += reading
    if not count:
        return None
    return total / count


class DataProcessor:
    """Stores the newest means in a deque without a maximum length."""

    def __init__(self, history=100):
        """Store at most `history` means."""
        self.size = history
        self.means = deque()

    def process(self, ranges, range_min, range_max):
        """Return the masked readings, and store their mean."""
        masked = mask_invalid(ranges, range_min, range_max)
        if (mean := mean_distance(masked)) is not None:
            self.means.append(mean)
        while len(self.means) > self.size:
            self.means.popleft()
        return masked

    def average(self):
        """Return the mean of the stored means, or None."""
        return sum(self.means) / len(self.means) if self.means else None
