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

"""What a scan says about a sector."""

import math

FRONT, LEFT, RIGHT = (quarter * math.pi / 2 for quarter in (0, 1, -1))


def _bearings(scan):
    """Yield the bearing of each beam (rad)."""
    for beam in range(len(scan.ranges)):
        yield scan.angle_min + beam * scan.angle_increment


def _counts(reading, scan):
    """Tell a distance or an infinity from a nan or a phantom."""
    if math.isinf(reading):
        return True
    return scan.range_min <= reading <= scan.range_max


def nearest(scan, middle, half_angle):
    """Return the nearest reading that counts, no more than half_angle from middle, or nan."""
    in_sector = (
        reading
        for bearing, reading in zip(_bearings(scan), scan.ranges)
        if math.fabs(math.remainder(bearing - middle, 2.0 * math.pi)) <= half_angle
    )
    by_distance = sorted(reading for reading in in_sector if _counts(reading, scan))
    return by_distance[0] if by_distance else math.nan
