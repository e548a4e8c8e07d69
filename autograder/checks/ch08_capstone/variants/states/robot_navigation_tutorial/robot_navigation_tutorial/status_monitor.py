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

"""The monitor as a set of watches, one for each topic."""

from dataclasses import dataclass

from geometry_msgs.msg import Twist
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, qos_profile_sensor_data, QoSProfile
from rclpy.time import Time
from robot_navigation_interfaces.msg import Clearance, Health
from sensor_msgs.msg import LaserScan

from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.running import run


@dataclass
class Watch:
    """The last message on a topic, and the time at which it came."""

    node: Node
    topic: str
    message: object = None
    when: Time | None = None

    def __call__(self, message):
        """Remember a message."""
        self.message, self.when = message, self.node.get_clock().now()

    def is_silent(self, now, seconds):
        """Return whether no message has come for more than `seconds`."""
        return self.when is None or (now - self.when).nanoseconds > seconds * 1e9


class StatusMonitor(Node):
    """Publishes two reports a second."""

    def __init__(self, **kwargs):
        """Create a watch and a subscription for each topic."""
        super().__init__('status_monitor', **kwargs)
        declare(self, 'silence_timeout', 1.0, 0.2, 1.4, 's until a topic counts as silent')
        kinds = {
            'scan': (LaserScan, qos_profile_sensor_data),
            'clearance': (Clearance, 10),
            'cmd_vel': (Twist, 10),
        }
        self.watches = {topic: Watch(self, topic) for topic in kinds}
        for topic, (kind, qos) in kinds.items():
            self.create_subscription(kind, topic, self.watches[topic], qos)
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.health = self.create_publisher(Health, 'health', latched)
        self.create_timer(0.5, self.report)

    def level(self, silent):
        """Return the level of the report."""
        if silent:
            return Health.FAILED
        return Health.OK if self.watches['clearance'].message.valid else Health.DEGRADED

    def report(self):
        """Publish the current health."""
        now, seconds = self.get_clock().now(), self.get_parameter('silence_timeout').value
        silent = [name for name, watch in self.watches.items() if watch.is_silent(now, seconds)]
        health = Health(level=self.level(silent), silent=silent)
        health.header.stamp = now.to_msg()
        self.health.publish(health)


def main(args=None):
    """Run the node until it is told to stop."""
    run(StatusMonitor, args)
