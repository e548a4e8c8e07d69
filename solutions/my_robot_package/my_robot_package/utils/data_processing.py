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

"""Clean and summarise laser ranges, without ROS: plain numbers in, plain numbers out."""

from collections import deque
from collections.abc import Sequence
import math

HISTORY = 100  # scans


def mask_invalid(ranges: Sequence[float], range_min: float, range_max: float) -> list[float]:
    """
    Return the ranges as a new list, with nan for each reading that is not a measurement.

    The result is as long as `ranges`: a reading's place determines its bearing, so none may
    be dropped. In REP 117, +inf means no return and -inf too near to measure, so both
    stay. A finite number outside range_min to range_max is not a measurement. All distances
    are in metres.
    """
    return [
        reading if math.isinf(reading) or range_min <= reading <= range_max else math.nan
        for reading in ranges
    ]


def mean_distance(ranges: Sequence[float]) -> float | None:
    """Return the mean of the finite readings in metres, or None when there is none."""
    finite = [reading for reading in ranges if math.isfinite(reading)]
    return math.fsum(finite) / len(finite) if finite else None


class DataProcessor:
    """Cleans scans, and remembers the mean distance of the newest ones."""

    def __init__(self, history: int = HISTORY) -> None:
        """Remember the means of at most `history` scans; a new one replaces the oldest."""
        self.history: deque[float] = deque(maxlen=history)

    def process(
        self, ranges: Sequence[float], range_min: float, range_max: float
    ) -> list[float]:
        """Return the masked ranges of one scan, and remember their mean if they have one."""
        masked = mask_invalid(ranges, range_min, range_max)
        mean = mean_distance(masked)
        if mean is not None:
            self.history.append(mean)
        return masked

    def average(self) -> float | None:
        """Return the mean of the remembered means in metres, or None when there is none."""
        return mean_distance(self.history)
