"""A node that reads its parameters at each tick, and validates them with a named tuple."""

import math
from typing import NamedTuple

from geometry_msgs.msg import Twist
from my_robot_package.configuration import contradiction, declare_configuration
from rcl_interfaces.msg import SetParametersResult
import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import BatteryState, LaserScan


class Distances(NamedTuple):
    """The two distances that have to fit together."""

    safety_distance: float
    slow_distance: float


class ConfiguredNode(Node):
    """Drives towards a wall and stops in front of it."""

    def __init__(self, **kwargs):
        """Declare the parameters, and create the endpoints and timers."""
        super().__init__('configured_node', **kwargs)
        declare_configuration(self)
        self.ahead, self.percent = math.nan, math.inf
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, qos_profile_sensor_data)
        self.create_subscription(BatteryState, 'battery_state', self.on_battery, qos_profile_sensor_data)
        self.blind = self.create_timer(0.5, lambda: setattr(self, 'ahead', math.nan))
        self.ticker = self.create_timer(1.0 / self.get_parameter('control_frequency').value, self.tick)
        self.add_on_set_parameters_callback(self.on_request)
        self.add_post_set_parameters_callback(self.on_change)

    def on_request(self, parameters):
        """Refuse a request with which the distances do not fit."""
        current = Distances(*(p.value for p in self.get_parameters(list(Distances._fields))))
        requested = {p.name: p.value for p in parameters if p.name in Distances._fields}
        reason = contradiction(*current._replace(**requested))
        return SetParametersResult(successful=reason == '', reason=reason)

    def on_change(self, parameters):
        """Set the ticker's period."""
        frequency = next((p.value for p in parameters if p.name == 'control_frequency'), None)
        if frequency is not None:
            self.ticker.timer_period_ns = int(1_000_000_000 / frequency)

    def on_scan(self, scan):
        """Store the distance straight ahead."""
        self.blind.reset()
        self.ahead = scan.ranges[int(round(-scan.angle_min / scan.angle_increment))]

    def on_battery(self, battery):
        """Store the charge in percent."""
        self.percent = battery.percentage * 100.0

    def tick(self):
        """Publish the speed that fits the distance, the charge and the parameters."""
        names = ('max_linear_velocity', 'safety_distance', 'slow_distance', 'battery_threshold')
        top, near, far, min_charge = (p.value for p in self.get_parameters(list(names)))
        twist = Twist()
        if self.ahead > near and not self.percent < min_charge:
            twist.linear.x = top if self.ahead >= far else top * (self.ahead - near) / (far - near)
        self.pub.publish(twist)


def main(args=None):
    """Run the node until it is interrupted."""
    rclpy.init(args=args)
    node = None
    executor = SingleThreadedExecutor()
    try:
        node = ConfiguredNode()
        executor.add_node(node)
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()
