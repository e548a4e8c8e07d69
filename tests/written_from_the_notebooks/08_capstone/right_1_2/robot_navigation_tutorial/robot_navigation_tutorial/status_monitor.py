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

"""The node that hears whether the others still speak."""

from geometry_msgs.msg import Twist
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, qos_profile_sensor_data, QoSProfile
from robot_navigation_interfaces.msg import Clearance, Health
from sensor_msgs.msg import LaserScan

from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.running import run

HEALTH_QOS = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
TOPICS = ('scan', 'clearance', 'cmd_vel')


class StatusMonitor(Node):
    """Listens to everything, says health."""

    def __init__(self, **kwargs):
        """Name it; make its ends; start its clockwork."""
        super().__init__('status_monitor', **kwargs)
        declare(self, 'silence_timeout', 1.0, 0.2, 1.4, 'A topic is silent after so long, s')
        self.heard = dict.fromkeys(TOPICS, float('-inf'))  # ns, when something arrived
        self.valid = False
        self.create_subscription(
            LaserScan, 'scan', self.scan_callback, qos_profile_sensor_data)
        self.create_subscription(Clearance, 'clearance', self.clearance_callback, 10)
        self.create_subscription(Twist, 'cmd_vel', self.command_callback, 10)
        self.publisher = self.create_publisher(Health, 'health', HEALTH_QOS)
        self.create_timer(0.5, self.report)

    def hear(self, topic):
        """Write down the time."""
        self.heard[topic] = self.get_clock().now().nanoseconds

    def scan_callback(self, scan):
        """Take note of a scan."""
        self.hear('scan')

    def clearance_callback(self, clearance):
        """Take note of a clearance."""
        self.hear('clearance')
        self.valid = clearance.valid

    def command_callback(self, command):
        """Take note of a command."""
        self.hear('cmd_vel')

    def report(self):
        """Say how it is."""
        now = self.get_clock().now()
        timeout = self.get_parameter('silence_timeout').value

        def is_silent(topic):
            """Say whether nothing has been heard for too long."""
            return (now.nanoseconds - self.heard[topic]) / 1e9 >= timeout

        silent = list(filter(is_silent, TOPICS))
        level = Health.FAILED if silent else Health.OK if self.valid else Health.DEGRADED
        health = Health(level=level, silent=silent)
        health.header.stamp = now.to_msg()
        self.publisher.publish(health)


def main(args=None):
    """Run the node until it is told to stop."""
    run(StatusMonitor, args)


if __name__ == '__main__':
    main()
