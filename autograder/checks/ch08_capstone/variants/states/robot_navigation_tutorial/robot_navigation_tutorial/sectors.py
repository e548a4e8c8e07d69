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

"""Sectors as cones that contain bearings."""

from dataclasses import dataclass
import math

FRONT, LEFT, RIGHT = 0.0, math.pi / 2, -math.pi / 2


@dataclass(frozen=True)
class Cone:
    """A sector: the bearing of its middle, and half its angle."""

    middle: float
    half: float

    def __contains__(self, bearing):
        """Return whether the cone contains a bearing, measured the shorter way round."""
        difference = abs(bearing - self.middle) % (2.0 * math.pi)
        return min(difference, 2.0 * math.pi - difference) <= self.half


def is_valid(reading, lowest, highest):
    """Return whether a reading is infinite or within the limits."""
    if math.isnan(reading):
        return False
    return math.isinf(reading) or lowest <= reading <= highest


def nearest(scan, middle, half_angle):
    """Return the smallest valid reading in a cone, or nan."""
    cone, smallest, bearing = Cone(middle, half_angle), None, scan.angle_min
    for number, reading in enumerate(scan.ranges):
        bearing = scan.angle_min + number * scan.angle_increment
        if bearing in cone and is_valid(reading, scan.range_min, scan.range_max):
            smallest = reading if smallest is None else min(smallest, reading)
    return math.nan if smallest is None else smallest
