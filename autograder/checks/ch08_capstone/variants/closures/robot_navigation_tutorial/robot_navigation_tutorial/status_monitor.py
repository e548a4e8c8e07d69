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

"""A monitor of closures, which share a dictionary of arrival times."""

from geometry_msgs.msg import Twist
import rclpy
from rclpy.duration import Duration
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from robot_navigation_interfaces.msg import Clearance, Health
from sensor_msgs.msg import LaserScan

from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.running import run

WATCHED = {'cmd_vel': Twist, 'clearance': Clearance, 'scan': LaserScan}


def qos_of(topic):
    """Return the quality of service for a subscription to the topic."""
    if topic == 'scan':
        return QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    return QoSProfile(depth=10)


def build():
    """Return the node."""
    node = rclpy.create_node('status_monitor')
    declare(node, 'silence_timeout', 1.0, 0.2, 1.4, 'seconds')
    arrivals, newest = {}, {}
    publisher = node.create_publisher(
        Health, 'health', QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))

    def subscribe(topic):
        def callback(message):
            arrivals[topic], newest[topic] = node.get_clock().now(), message

        node.create_subscription(WATCHED[topic], topic, callback, qos_of(topic))

    def report():
        now = node.get_clock().now()
        oldest = now - Duration(seconds=node.get_parameter('silence_timeout').value)
        silent = [topic for topic in WATCHED if topic not in arrivals or arrivals[topic] < oldest]
        health = Health(silent=silent, level=Health.FAILED)
        if not silent:
            health.level = Health.OK if newest['clearance'].valid else Health.DEGRADED
        health.header.stamp = now.to_msg()
        publisher.publish(health)

    for topic in WATCHED:
        subscribe(topic)
    node.create_timer(0.5, report)
    return node


def main(args=None):
    """Run the node until it is told to stop."""
    run(build, args)
