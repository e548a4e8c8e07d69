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

"""A watchdog that remembers when the last message came on each topic."""

from functools import partial

from geometry_msgs.msg import Twist
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.node import Node
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_sensor_data,
)
from robot_navigation_interfaces.msg import Clearance, Health
from robot_navigation_tutorial.running import run
from sensor_msgs.msg import LaserScan

TOPICS = {
    'scan': (LaserScan, qos_profile_sensor_data),
    'clearance': (Clearance, 10),
    'cmd_vel': (Twist, 10),
}
LATCHED = QoSProfile(
    history=HistoryPolicy.KEEP_LAST,
    depth=1,
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
)
NEVER = float('-inf')


class Watchdog(Node):
    """Has one subscription for each topic, all with the same callback."""

    def __init__(self):
        super().__init__('status_monitor')
        limits = FloatingPointRange(from_value=0.2, to_value=1.4)
        self.declare_parameter(
            'silence_timeout',
            1.0,
            ParameterDescriptor(description='seconds of silence', floating_point_range=[limits]),
        )
        self.arrivals = dict.fromkeys(TOPICS, NEVER)
        self.newest = {}
        for name, (kind, qos) in TOPICS.items():
            self.create_subscription(kind, name, partial(self.receive, name), qos)
        self.publisher = self.create_publisher(Health, 'health', LATCHED)
        self.timer = self.create_timer(0.5, self.report)

    def receive(self, name, message):
        """Remember the message and the time at which it came."""
        self.arrivals[name] = self.seconds()
        self.newest[name] = message

    def seconds(self):
        """Return the current time in seconds."""
        return self.get_clock().now().nanoseconds / 1e9

    def report(self):
        """Publish the current health."""
        oldest = self.seconds() - self.get_parameter('silence_timeout').value
        silent = sorted(name for name, time in self.arrivals.items() if time < oldest)
        report = Health(silent=silent)
        report.header.stamp = self.get_clock().now().to_msg()
        report.level = Health.FAILED if report.silent else Health.OK
        if not report.silent and not self.newest['clearance'].valid:
            report.level = Health.DEGRADED
        self.publisher.publish(report)


def main():
    """Run the node until it is told to stop."""
    run(Watchdog)
