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

"""The quality of service of the monitor's subscriptions."""

from rclpy.qos import ReliabilityPolicy
from robot_navigation_tutorial.status_monitor import qos_of


def test_a_lidar_is_heard():
    """Only scans are best effort."""
    assert qos_of('scan').reliability == ReliabilityPolicy.BEST_EFFORT
    assert qos_of('cmd_vel').reliability == ReliabilityPolicy.RELIABLE
