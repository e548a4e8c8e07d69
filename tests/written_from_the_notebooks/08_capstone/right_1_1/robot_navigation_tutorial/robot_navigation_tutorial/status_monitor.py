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

"""Twice a second, say which topics are silent."""

from functools import partial

from geometry_msgs.msg import Twist
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, qos_profile_sensor_data, QoSProfile, ReliabilityPolicy
from robot_navigation_interfaces.msg import Clearance, Health
from sensor_msgs.msg import LaserScan

from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.running import run

HEALTH_QOS = QoSProfile(
    depth=1,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
    reliability=ReliabilityPolicy.RELIABLE,
)


class StatusMonitor(Node):
    """Listens to all topics of the system."""

    def __init__(self, **kwargs):
        """Create the node, its parameter, its topics and its timer."""
        super().__init__('status_monitor', **kwargs)
        declare(self, 'silence_timeout', 1.0, 0.2, 1.4, 'Silence begins after so many seconds')
        self.heard = {}  # topic: when its newest message arrived
        self.newest = None
        for topic, kind, qos in (
            ('scan', LaserScan, qos_profile_sensor_data),
            ('cmd_vel', Twist, 10),
        ):
            self.create_subscription(kind, topic, partial(self.hear, topic), qos)
        self.create_subscription(Clearance, 'clearance', self.clearance_callback, 10)
        self.publisher = self.create_publisher(Health, 'health', HEALTH_QOS)
        self.create_timer(0.5, self.report)

    def hear(self, topic, message=None):
        """Remember when something arrived."""
        self.heard[topic] = self.get_clock().now()

    def clearance_callback(self, clearance):
        """Remember the clearance, and when it arrived."""
        self.hear('clearance')
        self.newest = clearance

    def report(self):
        """Publish a report."""
        now = self.get_clock().now()
        timeout = Duration(seconds=self.get_parameter('silence_timeout').value)
        report = Health()
        report.header.stamp = now.to_msg()
        for topic in ('scan', 'clearance', 'cmd_vel'):
            if topic not in self.heard or now - self.heard[topic] > timeout:
                report.silent.append(topic)
        if report.silent:
            report.level = Health.FAILED
        else:
            report.level = Health.OK if self.newest.valid else Health.DEGRADED
        self.publisher.publish(report)


def main(args=None):
    """Run the node until it is told to stop."""
    run(StatusMonitor, args)


if __name__ == '__main__':
    main()
