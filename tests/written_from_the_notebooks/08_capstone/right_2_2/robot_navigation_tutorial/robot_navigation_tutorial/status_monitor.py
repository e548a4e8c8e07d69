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

"""The nurse: listens to all topics, and reports who is silent."""

from geometry_msgs.msg import Twist
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, qos_profile_sensor_data, QoSProfile
from robot_navigation_interfaces.msg import Clearance, Health
from sensor_msgs.msg import LaserScan

from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.running import run

HEALTH_QOS = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Pulse:
    """When a topic was last heard, and what it said."""

    def __init__(self, node, kind, topic, qos):
        """Subscribe the node to the topic."""
        self._clock = node.get_clock()
        self.topic = topic
        self.last = None
        self._time = None
        node.create_subscription(kind, topic, self._hear, qos)

    def _hear(self, message):
        self.last, self._time = message, self._clock.now()

    def is_silent(self, now, timeout):
        """Return whether the last message is too long ago, or never came."""
        return self._time is None or self._time + timeout < now


class StatusMonitor(Node):
    """Publishes on health, and hears the other three topics."""

    def __init__(self, **kwargs):
        """Hand kwargs to Node."""
        super().__init__('status_monitor', **kwargs)
        declare(self, 'silence_timeout', 1.0, 0.2, 1.4, 's')
        self._scan = Pulse(self, LaserScan, 'scan', qos_profile_sensor_data)
        self._clearance = Pulse(self, Clearance, 'clearance', 10)
        self._command = Pulse(self, Twist, 'cmd_vel', 10)
        self.publisher = self.create_publisher(Health, 'health', HEALTH_QOS)
        self.create_timer(0.5, self.report)

    def report(self):
        """Publish who is silent, and how bad that is."""
        now = self.get_clock().now()
        timeout = Duration(seconds=self.get_parameter('silence_timeout').value)
        pulses = (self._scan, self._clearance, self._command)
        silent = [pulse.topic for pulse in pulses if pulse.is_silent(now, timeout)]
        level = Health.OK
        if silent:
            level = Health.FAILED
        elif not self._clearance.last.valid:
            level = Health.DEGRADED
        health = Health(level=level, silent=silent)
        health.header.stamp = now.to_msg()
        self.publisher.publish(health)


def main(args=None):
    """Be an executable."""
    run(StatusMonitor, args)


if __name__ == '__main__':
    main()
