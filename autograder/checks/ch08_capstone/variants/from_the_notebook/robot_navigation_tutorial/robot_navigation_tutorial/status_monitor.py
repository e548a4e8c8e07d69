"""The node that reports the health of the navigation."""

from functools import partial

from geometry_msgs.msg import Twist
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, qos_profile_sensor_data, QoSProfile
from robot_navigation_interfaces.msg import Clearance, Health
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Header

from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.running import run

REPORT_PERIOD = 0.5
HEALTH_QOS = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
WATCHED = {
    'cmd_vel': (Twist, 10),
    'clearance': (Clearance, 10),
    'scan': (LaserScan, qos_profile_sensor_data),
}


class StatusMonitor(Node):
    """Publishes two reports a second."""

    def __init__(self, **kwargs):
        """Create the node."""
        super().__init__('status_monitor', **kwargs)
        declare(self, 'silence_timeout', 1.0, 0.2, 1.4, 's without a message that are silence')
        self.arrivals = {}
        self.clearance = None
        self.level = None
        self.publisher = self.create_publisher(Health, 'health', HEALTH_QOS)
        for topic, (kind, qos) in WATCHED.items():
            self.create_subscription(kind, topic, partial(self.on_message, topic), qos)
        self.create_timer(REPORT_PERIOD, self.report)

    def on_message(self, topic, message):
        """Remember the time of the message, and the newest clearance."""
        self.arrivals[topic] = self.get_clock().now().nanoseconds
        if topic == 'clearance':
            self.clearance = message

    def report(self):
        """Publish the current health."""
        now = self.get_clock().now()
        oldest = now.nanoseconds - self.get_parameter('silence_timeout').value * 1e9
        silent = [t for t in WATCHED if t not in self.arrivals or self.arrivals[t] <= oldest]
        if silent:
            level = Health.FAILED
        elif not self.clearance.valid:
            level = Health.DEGRADED
        else:
            level = Health.OK
        if level != self.level:
            self.get_logger().info(f'level {self.level} -> {level}, silent: {silent}')
            self.level = level
        self.publisher.publish(
            Health(header=Header(stamp=now.to_msg()), level=level, silent=silent))


def main(args=None):
    """Run the node until it is told to stop."""
    run(StatusMonitor, args)


if __name__ == '__main__':
    main()
