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

"""The nearest distance in a sector, by a generator of valid readings."""

import math

FRONT, LEFT, RIGHT = 0.0, 0.5 * math.pi, -0.5 * math.pi


def wrapped(angle):
    """Return the angle, wrapped to between -pi and pi."""
    while angle > math.pi:
        angle -= 2.0 * math.pi
    while angle < -math.pi:
        angle += 2.0 * math.pi
    return angle


def nearest(scan, middle, half_angle):
    """Return the nearest distance around a bearing."""
    def readings():
        for index, reading in enumerate(scan.ranges):
            difference = wrapped(scan.angle_min + index * scan.angle_increment - middle)
            if -half_angle <= difference <= half_angle:
                if reading in (math.inf, -math.inf) or scan.range_min <= reading <= scan.range_max:
                    yield reading

    return sorted(readings(), reverse=True)[-1] if any(True for _ in readings()) else math.nan
