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

"""A node without a class: it turns scans into clearances."""

import math

import rclpy
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.qos import QoSProfile, ReliabilityPolicy
from robot_navigation_interfaces.msg import Clearance
from robot_navigation_tutorial.sectors import FRONT, LEFT, RIGHT, nearest
from sensor_msgs.msg import LaserScan


def process(half_angle, scan):
    """Return the clearance of a scan."""
    clearance = Clearance(header=scan.header)
    clearance.front = nearest(scan, FRONT, half_angle)
    clearance.left = nearest(scan, LEFT, half_angle)
    clearance.right = nearest(scan, RIGHT, half_angle)
    clearance.valid = not (
        math.isnan(clearance.front) or math.isnan(clearance.left) or math.isnan(clearance.right)
    )
    return clearance


def make(**kwargs):
    """Return the node with its publisher and subscription."""
    node = rclpy.create_node('sensor_processor', **kwargs)
    descriptor = ParameterDescriptor(description='half of a sector in rad')
    descriptor.floating_point_range = [FloatingPointRange(from_value=0.1, to_value=0.78)]
    node.declare_parameter('half_angle', 0.52, descriptor)
    publisher = node.create_publisher(Clearance, 'clearance', 10)

    def on_scan(scan):
        publisher.publish(process(node.get_parameter('half_angle').value, scan))

    best_effort = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    node.create_subscription(LaserScan, 'scan', on_scan, best_effort)
    return node


def main():
    """Run the node until it is told to stop."""
    rclpy.init()
    node = make()
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()
