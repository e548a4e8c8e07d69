"""Settings in a frozen dataclass that is replaced as a whole, with two threads and a lock."""

from dataclasses import dataclass, fields, replace
import threading

from geometry_msgs.msg import Twist, Vector3
from my_robot_package.configuration import contradiction, declare_configuration
import numpy as np
from rcl_interfaces.msg import SetParametersResult
import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import BatteryState, LaserScan


@dataclass(frozen=True)
class Settings:
    """The parameters that determine the speed and its rate."""

    max_linear_velocity: float
    safety_distance: float
    slow_distance: float
    control_frequency: float
    battery_threshold: int

    def speed(self, ahead, charge):
        """Return the speed for a gap and a charge in percent, each None if unknown."""
        if ahead is None or np.isnan(ahead) or (charge is not None and charge < self.battery_threshold):
            return 0.0
        gaps, shares = (self.safety_distance, self.slow_distance), (0.0, self.max_linear_velocity)
        return float(np.interp(ahead, gaps, shares))


NAMES = tuple(field.name for field in fields(Settings))


class ConfiguredNode(Node):
    """A node with settings, the last distance and charge, and a lock."""

    def __init__(self, **kwargs):
        """Create all endpoints and timers in one callback group."""
        super().__init__('configured_node', **kwargs)
        declare_configuration(self)
        self.lock, self.group = threading.RLock(), ReentrantCallbackGroup()
        self.settings = Settings(**{name: self.get_parameter(name).value for name in NAMES})
        self.ahead, self.charge = None, None
        self.out = self.create_publisher(Twist, 'cmd_vel', 10)
        for kind, topic, callback in (
                (LaserScan, 'scan', self.on_scan), (BatteryState, 'battery_state', self.on_battery)):
            self.create_subscription(kind, topic, callback, qos_profile_sensor_data, callback_group=self.group)
        self.watchdog = self.create_timer(0.5, self.forget_distance, callback_group=self.group)
        self.timer = self.create_timer(
            1.0 / self.settings.control_frequency, self.drive, callback_group=self.group)
        self.add_on_set_parameters_callback(self.on_request)
        self.add_post_set_parameters_callback(self.on_change)

    def proposed(self, parameters):
        """Return the settings with these parameters changed."""
        with self.lock:
            return replace(self.settings, **{p.name: p.value for p in parameters if p.name in NAMES})

    def on_request(self, parameters):
        """Refuse distances that do not fit together."""
        settings = self.proposed(parameters)
        reason = contradiction(settings.safety_distance, settings.slow_distance)
        return SetParametersResult(successful=not reason, reason=reason)

    def on_change(self, parameters):
        """Replace the settings, and set the timer if its frequency has changed."""
        with self.lock:
            before, self.settings = self.settings, self.proposed(parameters)
        if self.settings.control_frequency != before.control_frequency:
            self.timer.timer_period_ns = round(10**9 / self.settings.control_frequency)

    def on_scan(self, scan):
        """Store the distance straight ahead."""
        with self.lock:
            self.ahead = scan.ranges[round(-scan.angle_min / scan.angle_increment)]
        self.watchdog.reset()

    def forget_distance(self):
        """Forget a distance that is too old."""
        with self.lock:
            self.ahead = None

    def on_battery(self, battery):
        """Store the charge in percent."""
        with self.lock:
            self.charge = 100.0 * battery.percentage

    def drive(self):
        """Publish the speed."""
        with self.lock:
            speed = self.settings.speed(self.ahead, self.charge)
        self.out.publish(Twist(linear=Vector3(x=speed)))


def main(args=None):
    """Run the node with two threads."""
    rclpy.init(args=args)
    executor = MultiThreadedExecutor(num_threads=2)
    try:
        executor.add_node(ConfiguredNode())
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
