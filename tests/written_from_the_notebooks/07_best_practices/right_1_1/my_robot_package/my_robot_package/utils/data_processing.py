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

"""What a laser scan measured, and how far away things were: numbers in, numbers out."""

from collections.abc import Sequence
from math import inf, isfinite, nan
from statistics import fmean


def mask_invalid(ranges: Sequence[float], range_min: float, range_max: float) -> list[float]:
    """Return a copy of ranges, in metres, in which nan stands where nothing was measured."""
    copy = []
    for reading in ranges:
        measured = range_min <= reading <= range_max
        said = reading == inf or reading == -inf  # REP 117: nothing came back, or too near
        copy.append(float(reading) if measured or said else nan)
    return copy


def mean_distance(ranges: Sequence[float]) -> float | None:
    """Return how many metres the finite readings are on average, or None without any."""
    try:
        return fmean(filter(isfinite, ranges))
    except ValueError:  # fmean was given nothing
        return None


class DataProcessor:
    """The mean distances of the newest scans."""

    def __init__(self, history: int = 100) -> None:
        """Begin without a mean; remember so many at most."""
        self.history: list[float] = []
        self._room = history

    def process(
        self, ranges: Sequence[float], range_min: float, range_max: float
    ) -> list[float]:
        """Return the ranges masked; remember their mean if they have one."""
        masked = mask_invalid(ranges, range_min, range_max)
        self._remember(mean_distance(masked))
        return masked

    def average(self) -> float | None:
        """Return the mean of the means that are remembered, or None when there are none."""
        return fmean(self.history) if len(self.history) > 0 else None

    def _remember(self, mean):
        if mean is None:
            return
        self.history.append(mean)
        while len(self.history) > self._room:
            self.history.pop(0)
