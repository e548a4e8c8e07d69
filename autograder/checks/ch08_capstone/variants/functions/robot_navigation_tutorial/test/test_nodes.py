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

"""The clearance of a scan, without a node."""

import math
from types import SimpleNamespace

from robot_navigation_tutorial.sensor_processor import process
from sensor_msgs.msg import LaserScan


def test_a_blind_scan_is_not_valid():
    """Each reading is nan."""
    scan = LaserScan(range_min=0.1, range_max=5.0, angle_increment=0.1, ranges=[math.nan] * 62)
    assert not process(0.5, scan).valid


def test_a_wall_ahead_is_seen():
    """Only the reading at bearing 0 is nearer."""
    scan = LaserScan(range_min=0.1, range_max=5.0, angle_increment=0.1, ranges=[2.0] * 62)
    scan.ranges[0] = 1.0
    clearance = process(0.5, scan)
    assert clearance.valid
    assert SimpleNamespace(front=clearance.front, left=clearance.left).__dict__ == {
        'front': 1.0,
        'left': 2.0,
    }
