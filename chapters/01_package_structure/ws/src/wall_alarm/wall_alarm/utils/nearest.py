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


"""What is nearest in a laser scan."""

import numpy as np


def nearest(scan):
    """
    Return the distance to the nearest thing around the robot, in metres.

    Readings count as REP 117 says: inf when nothing is within range, -inf when something is
    too near to measure, None when no reading is valid.
    """
    ranges = np.asarray(scan.ranges)
    counts = np.isinf(ranges) | ((ranges >= scan.range_min) & (ranges <= scan.range_max))
    return float(ranges[counts].min()) if counts.any() else None
