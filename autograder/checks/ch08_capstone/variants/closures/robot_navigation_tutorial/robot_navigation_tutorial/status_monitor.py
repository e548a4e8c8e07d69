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

"""Three times of arrival, in a dictionary that closures share."""

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
    """Return what to ask for."""
    if topic == 'scan':
        return QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    return QoSProfile(depth=10)


def build():
    """Return the node."""
    node = rclpy.create_node('status_monitor')
    declare(node, 'silence_timeout', 1.0, 0.2, 1.4, 'seconds')
    arrived, last = {}, {}
    out = node.create_publisher(
        Health, 'health', QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))

    def listen(topic):
        def hear(message):
            arrived[topic], last[topic] = node.get_clock().now(), message

        node.create_subscription(WATCHED[topic], topic, hear, qos_of(topic))

    def report():
        now = node.get_clock().now()
        oldest = now - Duration(seconds=node.get_parameter('silence_timeout').value)
        silent = [topic for topic in WATCHED if topic not in arrived or arrived[topic] < oldest]
        health = Health(silent=silent, level=Health.FAILED)
        if not silent:
            health.level = Health.OK if last['clearance'].valid else Health.DEGRADED
        health.header.stamp = now.to_msg()
        out.publish(health)

    for topic in WATCHED:
        listen(topic)
    node.create_timer(0.5, report)
    return node


def main(args=None):
    """Run it."""
    run(build, args)
