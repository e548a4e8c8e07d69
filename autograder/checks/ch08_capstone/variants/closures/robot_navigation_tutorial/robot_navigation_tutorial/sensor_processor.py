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

"""A node whose only callback is a coroutine: it turns scans into clearances."""

import math

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.qos import HistoryPolicy, QoSProfile, ReliabilityPolicy
from robot_navigation_interfaces.msg import Clearance
from sensor_msgs.msg import LaserScan

from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.running import run
from robot_navigation_tutorial.sectors import FRONT, LEFT, nearest, RIGHT

LIDAR = QoSProfile(
    history=HistoryPolicy.KEEP_LAST, depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)


def build():
    """Return the node."""
    node = rclpy.create_node('sensor_processor')
    declare(node, 'half_angle', 0.52, 0.1, 0.78, 'half of a sector, in rad')
    publisher = node.create_publisher(Clearance, 'clearance', QoSProfile(depth=10))

    async def process(scan):
        half = node.get_parameter('half_angle').get_parameter_value().double_value
        clearance = Clearance()
        clearance.header = scan.header
        clearance.front, clearance.left, clearance.right = (
            nearest(scan, middle, half) for middle in (FRONT, LEFT, RIGHT))
        distances = (clearance.front, clearance.left, clearance.right)
        clearance.valid = True not in [math.isnan(distance) for distance in distances]
        publisher.publish(clearance)

    node.create_subscription(
        LaserScan, 'scan', process, LIDAR, callback_group=ReentrantCallbackGroup())
    return node


def main(args=None):
    """Run the node until it is told to stop."""
    run(build, args)
