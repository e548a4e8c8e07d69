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

"""The nearest thing in a sector of a laser scan."""

import math

FRONT = math.radians(0.0)
LEFT = math.radians(90.0)
RIGHT = -LEFT


def _distance(one, other):
    """Return the angle between two bearings, the shorter way round."""
    angle = math.fmod(abs(one - other), math.tau)
    return min(angle, math.tau - angle)


def _counts(scan, reading):
    """Say whether a reading counts by REP 117."""
    if math.isfinite(reading):
        return scan.range_min <= reading <= scan.range_max
    return not math.isnan(reading)


def nearest(scan, middle, half_angle):
    """Return the least reading of a sector that counts, or nan."""
    least = math.nan
    for index, reading in enumerate(scan.ranges):
        bearing = scan.angle_min + index * scan.angle_increment
        if _distance(bearing, middle) > half_angle or not _counts(scan, reading):
            continue
        if math.isnan(least) or reading < least:
            least = reading
    return least
