# Copyright 2026 The ROS 2 Python Course Authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Numbers of a lidar: which of them count, and what they come to on average."""

from array import array
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import partial
from itertools import islice
from math import isfinite, isinf, nan


def _clean(reading: float, /, nearest: float, farthest: float) -> float:
    """Return the reading if it says something, else nan."""
    says_something = isinf(reading) or not (
        reading != reading or reading < nearest or reading > farthest)
    return reading if says_something else nan


def mask_invalid(ranges: Sequence[float], range_min: float, range_max: float) -> list[float]:
    """
    Return one number for each reading, in the same order.

    An infinity is a statement, and a number from range_min to range_max (m) is a distance; both
    stay. In place of all else there is nan.
    """
    return [*map(partial(_clean, nearest=range_min, farthest=range_max), ranges)]


def _mean(numbers: Iterable[float]) -> float | None:
    total, count = 0.0, 0
    for number in numbers:
        total, count = total + number, count + 1
    try:
        return total / count
    except ZeroDivisionError:
        return None


def mean_distance(ranges: Sequence[float]) -> float | None:
    """Return what the finite readings are on average (m), or None if there are none."""
    return _mean(number for number in ranges if isfinite(number))


@dataclass
class DataProcessor:
    """
    A mask with a memory.

    The means stand in a ring: the next one goes to the place of the oldest as soon as all
    places are taken.
    """

    history: int = 100
    _ring: array = field(default_factory=partial(array, 'd'), init=False, repr=False)
    _count: int = field(default=0, init=False, repr=False)

    def process(
        self, ranges: Sequence[float], range_min: float, range_max: float
    ) -> list[float]:
        """Return the masked ranges, and put their mean, if any, into the ring."""
        masked = mask_invalid(ranges, range_min, range_max)
        if (mean := mean_distance(masked)) is not None and self.history > 0:
            if len(self._ring) < self.history:
                self._ring.append(mean)
            else:
                self._ring[self._count % self.history] = mean
            self._count += 1
        return masked

    def average(self) -> float | None:
        """Return the mean of what is in the ring (m), or None while it is empty."""
        return _mean(islice(self._ring, self.history))
