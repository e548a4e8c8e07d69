"""Settings are a frozen dataclass, replaced as a whole; two threads and a lock."""

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
    """What it drives by."""

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


NAMES = tuple(each.name for each in fields(Settings))


class ConfiguredNode(Node):
    """Holds its settings, the sight and a lock."""

    def __init__(self, **kwargs):
        """Connect everything in one group."""
        super().__init__('configured_node', **kwargs)
        declare_configuration(self)
        self.lock, self.group = threading.RLock(), ReentrantCallbackGroup()
        self.settings = Settings(**{name: self.get_parameter(name).value for name in NAMES})
        self.ahead, self.charge, self.looks = None, None, 0
        self.out = self.create_publisher(Twist, 'cmd_vel', 10)
        for kind, topic, callback in (
                (LaserScan, 'scan', self.scanned), (BatteryState, 'battery_state', self.charged)):
            self.create_subscription(kind, topic, callback, qos_profile_sensor_data, callback_group=self.group)
        self.sight = self.create_timer(0.5, self.lose_sight, callback_group=self.group)
        self.timer = self.create_timer(
            1.0 / self.settings.control_frequency, self.drive, callback_group=self.group)
        self.add_on_set_parameters_callback(self.may)
        self.add_post_set_parameters_callback(self.did)

    def proposed(self, parameters):
        """Return the settings as they would be."""
        with self.lock:
            return replace(self.settings, **{each.name: each.value for each in parameters if each.name in NAMES})

    def may(self, parameters):
        """Judge."""
        wanted = self.proposed(parameters)
        why = contradiction(wanted.safety_distance, wanted.slow_distance)
        return SetParametersResult(successful=not why, reason=why)

    def did(self, parameters):
        """Take over."""
        with self.lock:
            before, self.settings = self.settings, self.proposed(parameters)
        if self.settings.control_frequency != before.control_frequency:
            self.timer.timer_period_ns = round(10**9 / self.settings.control_frequency)

    def scanned(self, scan):
        """See."""
        with self.lock:
            self.ahead = scan.ranges[round(-scan.angle_min / scan.angle_increment)]
        self.sight.reset()

    def lose_sight(self):
        """See nothing."""
        with self.lock:
            self.ahead = None

    def charged(self, battery):
        """Hear of the battery."""
        with self.lock:
            self.charge = 100.0 * battery.percentage

    def drive(self):
        """Publish."""
        with self.lock:
            speed = self.settings.speed(self.ahead, self.charge)
        self.out.publish(Twist(linear=Vector3(x=speed)))


def main(args=None):
    """Run it."""
    rclpy.init(args=args)
    executor = MultiThreadedExecutor(num_threads=2)
    try:
        executor.add_node(ConfiguredNode())
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
