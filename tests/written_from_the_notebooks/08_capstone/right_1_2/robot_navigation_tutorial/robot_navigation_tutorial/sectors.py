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

"""Sectors of a laser scan."""

from math import inf, isinf, nan, pi, remainder, tau

FRONT, LEFT, RIGHT = 0.0, 0.5 * pi, -0.5 * pi


def readings_in(scan, middle, half_angle):
    """Yield the readings of a sector."""
    for index, reading in enumerate(scan.ranges):
        bearing = scan.angle_min + index * scan.angle_increment
        if -half_angle <= remainder(bearing - middle, tau) <= half_angle:
            yield reading


def nearest(scan, middle, half_angle):
    """Return the distance to the nearest thing in a sector."""
    distances, far, near = [], False, False
    for reading in readings_in(scan, middle, half_angle):
        if isinf(reading):
            far |= reading > 0.0
            near |= reading < 0.0
        elif scan.range_min <= reading <= scan.range_max:
            distances.append(reading)
    if near:
        return -inf
    if distances:
        return min(distances)
    return inf if far else nan
