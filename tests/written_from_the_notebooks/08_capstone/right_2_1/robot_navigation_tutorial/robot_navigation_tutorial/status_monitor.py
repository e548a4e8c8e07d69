"""Node status_monitor: whether every topic is alive, and whether the lidar sees."""

from functools import partial

from geometry_msgs.msg import Twist
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, qos_profile_sensor_data, QoSProfile
from robot_navigation_interfaces.msg import Clearance, Health
from sensor_msgs.msg import LaserScan

from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.running import run

HEALTH_QOS = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
TOPICS = {
    'scan': (LaserScan, qos_profile_sensor_data),
    'clearance': (Clearance, 10),
    'cmd_vel': (Twist, 10),
}


class StatusMonitor(Node):
    """Listens to the others, and says twice a second how they are."""

    def __init__(self, **kwargs) -> None:
        """Set the node up; kwargs are those of Node."""
        super().__init__('status_monitor', **kwargs)
        declare(self, 'silence_timeout', 1.0, 0.2, 1.4, 'longest wait for a message, s')
        self.arrivals = {}  # topic: nanoseconds
        self.is_valid = False
        self.publisher = self.create_publisher(Health, 'health', HEALTH_QOS)
        for topic, (kind, qos) in TOPICS.items():
            self.create_subscription(kind, topic, partial(self.hear, topic), qos)
        self.timer = self.create_timer(0.5, self.report)

    def hear(self, topic: str, message=None) -> None:
        """Note that a topic is alive; of a clearance, also whether it is valid."""
        self.arrivals[topic] = self.get_clock().now().nanoseconds
        if topic == 'clearance' and message is not None:
            self.is_valid = message.valid

    def clearance_callback(self, clearance: Clearance) -> None:
        """Take a clearance that did not come over its topic."""
        self.hear('clearance', clearance)

    def report(self) -> None:
        """Publish a report."""
        now = self.get_clock().now()
        longest = self.get_parameter('silence_timeout').value * 1e9
        health = Health()
        health.header.stamp = now.to_msg()
        for topic in TOPICS:
            arrival = self.arrivals.get(topic)
            if arrival is None or now.nanoseconds - arrival > longest:
                health.silent.append(topic)
        if len(health.silent) > 0:
            health.level = Health.FAILED
        else:
            health.level = Health.OK if self.is_valid else Health.DEGRADED
        self.publisher.publish(health)


def main(args=None) -> None:
    """Start the program."""
    run(StatusMonitor, args)


if __name__ == '__main__':
    main()
