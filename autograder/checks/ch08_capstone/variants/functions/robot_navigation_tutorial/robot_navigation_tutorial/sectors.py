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

"""The nearest distance in a sector, computed with arrays."""

import math

import numpy as np

FRONT, LEFT, RIGHT = 0.0, math.pi / 2, -math.pi / 2


def nearest(scan, middle, half_angle):
    """Return the nearest distance around a bearing, or nan."""
    ranges = np.asarray(scan.ranges, dtype=float)
    difference = scan.angle_min + np.arange(len(ranges)) * scan.angle_increment - middle
    difference = np.abs(np.arctan2(np.sin(difference), np.cos(difference)))
    is_valid = np.isinf(ranges) | ((ranges >= scan.range_min) & (ranges <= scan.range_max))
    valid = ranges[is_valid & (difference <= half_angle)]
    return float(valid.min()) if valid.size else math.nan
