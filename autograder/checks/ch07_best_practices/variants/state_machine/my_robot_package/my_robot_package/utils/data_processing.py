"""Plain loops, and a running sum."""

from collections import deque
from math import isfinite, isnan, nan


def mask_invalid(ranges, range_min, range_max):
    """Go through the readings one by one."""
    kept = []
    for reading in ranges:
        if isnan(reading):
            kept.append(nan)
        elif not isfinite(reading):
            kept.append(reading)
        elif reading < range_min or reading > range_max:
            kept.append(nan)
        else:
            kept.append(reading)
    return kept


def mean_distance(ranges):
    """Add up and divide."""
    count, total = 0, 0.0
    for reading in filter(isfinite, ranges):
        count += 1
        total += reading
    if not count:
        return None
    return total / count


class DataProcessor:
    """Remembers means in a deque that it shortens itself."""

    def __init__(self, history=100):
        """Remember so many."""
        self.size = history
        self.means = deque()

    def process(self, ranges, range_min, range_max):
        """Mask, and remember."""
        masked = mask_invalid(ranges, range_min, range_max)
        if (mean := mean_distance(masked)) is not None:
            self.means.append(mean)
        while len(self.means) > self.size:
            self.means.popleft()
        return masked

    def average(self):
        """Return the mean of means."""
        return sum(self.means) / len(self.means) if self.means else None
