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

"""The node that watches: which topics are silent, and whether the lidar sees."""

from geometry_msgs.msg import Twist
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, qos_profile_sensor_data, QoSProfile
from robot_navigation_interfaces.msg import Clearance, Health
from sensor_msgs.msg import LaserScan

from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.running import run

REPORT_PERIOD = 0.5  # s
# A node that joins late gets the last report immediately if it asks for the same durability.
HEALTH_QOS = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class StatusMonitor(Node):
    """
    Reports twice a second how the navigation system is doing.

    Subscribes to scan (sensor_msgs/LaserScan), clearance
    (robot_navigation_interfaces/Clearance) and cmd_vel (geometry_msgs/Twist), publishes
    health (robot_navigation_interfaces/Health).
    """

    def __init__(self, **kwargs):
        """
        Name the node status_monitor; declare its parameter, create its topics.

        silence_timeout: 1.0 s, from 0.2 to 1.4. scan: qos_profile_sensor_data. clearance and
        cmd_vel: queues of 10. health: HEALTH_QOS. A timer calls report every REPORT_PERIOD.
        kwargs are passed on to Node.
        """
        super().__init__('status_monitor', **kwargs)
        declare(self, 'silence_timeout', 1.0, 0.2, 1.4, 's: no message for so long is silence')
        self.heard = {'scan': None, 'clearance': None, 'cmd_vel': None}  # time of arrival
        self.sees = False
        self.publisher = self.create_publisher(Health, 'health', HEALTH_QOS)
        self.create_subscription(
            LaserScan, 'scan', lambda _: self.hear('scan'), qos_profile_sensor_data)
        self.create_subscription(Clearance, 'clearance', self.clearance_callback, 10)
        self.create_subscription(Twist, 'cmd_vel', lambda _: self.hear('cmd_vel'), 10)
        self.create_timer(REPORT_PERIOD, self.report)

    def hear(self, topic):
        """Remember that a message on this topic has just arrived."""
        self.heard[topic] = self.get_clock().now()

    def clearance_callback(self, clearance):
        """Remember that a clearance has arrived, and whether it is valid."""
        self.hear('clearance')
        self.sees = clearance.valid

    def report(self):
        """Publish the current health."""
        now = self.get_clock().now()
        timeout = Duration(seconds=self.get_parameter('silence_timeout').value)
        health = Health(silent=[
            topic for topic, time in self.heard.items() if time is None or now - time > timeout])
        health.header.stamp = now.to_msg()
        if health.silent:
            health.level = Health.FAILED
        elif not self.sees:
            health.level = Health.DEGRADED
        else:
            health.level = Health.OK
        self.publisher.publish(health)


def main(args=None):
    """Run the node until it is told to stop."""
    run(StatusMonitor, args)


if __name__ == '__main__':
    main()
