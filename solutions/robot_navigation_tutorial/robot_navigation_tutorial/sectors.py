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

"""How near things are, sector by sector: the part of the sensor processor without ROS."""

import math

FRONT, LEFT, RIGHT = 0.0, math.pi / 2, -math.pi / 2  # rad: the bearings of the sectors' middles


def nearest(scan, middle, half_angle):
    """
    Return the distance to the nearest thing in a sector, in metres.

    scan is a sensor_msgs/LaserScan. Beam i has the bearing angle_min + i * angle_increment.
    It belongs to the sector when this bearing is at most half_angle from middle, the
    shorter way round. REP 117 says what its reading means:

    nan                               invalid, as if the beam were not there
    +inf                              nothing within range_max
    -inf                              something nearer than range_min
    range_min <= reading <= range_max a distance
    any other number                  a phantom, as if the beam were not there

    So the answer is a distance, math.inf, -math.inf, or math.nan when no reading counts.
    """
    readings = [
        reading
        for index, reading in enumerate(scan.ranges)
        if abs(math.remainder(scan.angle_min + index * scan.angle_increment - middle, math.tau))
        <= half_angle
        and (math.isinf(reading) or scan.range_min <= reading <= scan.range_max)
    ]
    return min(readings, default=math.nan)
