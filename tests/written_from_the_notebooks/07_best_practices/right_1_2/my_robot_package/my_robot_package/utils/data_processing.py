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

"""Arithmetic on laser ranges (metres) that needs no robot."""

from collections import deque
from collections.abc import Iterable, Sequence
import math


def _valid(reading: float, nearest: float, farthest: float) -> bool:
    return not (math.isnan(reading) or math.isfinite(reading) and (
        reading < nearest or reading > farthest))


def _mean(numbers: Iterable[float]) -> float | None:
    """Return the mean of what is finite; numbers may be read only once."""
    total, count = [], 0
    for count, number in enumerate((x for x in numbers if math.isfinite(x)), start=1):
        total.append(number)
    return None if count == 0 else math.fsum(total) / count


def mask_invalid(ranges: Sequence[float], range_min: float, range_max: float) -> list[float]:
    """Return a list as long as ranges, with nan for each reading that is none."""
    masked = list(ranges)
    for index, reading in enumerate(masked):
        if not _valid(reading, range_min, range_max):
            masked[index] = math.nan
    return masked


def mean_distance(ranges: Sequence[float]) -> float | None:
    """Return the mean of the finite readings, or None."""
    return _mean(ranges)


class DataProcessor:
    """A mask for scans that remembers their means."""

    def __init__(self, history: int = 100) -> None:
        """Remember no more than so many means."""
        self._means = deque([], history)

    def process(
        self, ranges: Sequence[float], range_min: float, range_max: float
    ) -> list[float]:
        """Mask ranges and return them; keep the mean in mind."""
        masked = mask_invalid(ranges, range_min, range_max)
        self._means.extend(mean for mean in [_mean(masked)] if mean is not None)
        return masked

    def average(self) -> float | None:
        """Return the mean of what is in mind."""
        return _mean(self._means)
