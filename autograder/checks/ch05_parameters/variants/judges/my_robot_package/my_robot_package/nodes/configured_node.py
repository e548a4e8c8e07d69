"""A plain node with a validator, a rate keeper and a driver, which main combines."""

from geometry_msgs.msg import Twist
from my_robot_package.configuration import contradiction, declare_configuration
from rcl_interfaces.msg import SetParametersResult
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import BatteryState, LaserScan


class Validator:
    """Accepts or refuses requests to set parameters."""

    def __init__(self, read):
        """Store the function that reads a current value."""
        self.read = read

    def __call__(self, parameters):
        """Refuse a request with which the distances do not fit."""
        proposed = {name: self.read(name) for name in ('safety_distance', 'slow_distance')}
        for parameter in parameters:
            if parameter.name in proposed:
                proposed[parameter.name] = parameter.value
        problem = contradiction(**proposed)
        answer = SetParametersResult()
        answer.successful, answer.reason = not problem, problem
        return answer


class RateKeeper:
    """Calls a function at a frequency that may change."""

    def __init__(self, node, tick):
        """Start the timer with the parameter's frequency."""
        self.node, self.tick = node, tick
        self.start(node.get_parameter('control_frequency').value)

    def start(self, frequency):
        """Create a timer with this frequency."""
        self.timer = self.node.create_timer(1.0 / frequency, self.tick)

    def __call__(self, parameters):
        """Replace the timer if the frequency has changed."""
        for parameter in parameters:
            if parameter.name == 'control_frequency':
                self.timer.cancel()
                self.node.destroy_timer(self.timer)
                self.start(parameter.value)


class Driver:
    """Stores the sensors' data, and publishes commands."""

    def __init__(self, node):
        """Create the publisher and the subscriptions."""
        self.node, self.read = node, lambda name: node.get_parameter(name).value
        self.distance, self.scan_time, self.charge = None, None, None
        self.publisher = node.create_publisher(Twist, 'cmd_vel', 10)
        node.create_subscription(LaserScan, 'scan', self.on_scan, qos_profile_sensor_data)
        node.create_subscription(BatteryState, 'battery_state', self.on_battery, qos_profile_sensor_data)

    def on_scan(self, scan):
        """Store the distance straight ahead and the current time."""
        self.distance = scan.ranges[round((0.0 - scan.angle_min) / scan.angle_increment)]
        self.scan_time = self.node.get_clock().now()

    def on_battery(self, battery):
        """Store the charge in percent."""
        self.charge = battery.percentage * 100.0

    def is_blind(self):
        """Return whether the last distance is too old."""
        return self.scan_time is None or (self.node.get_clock().now() - self.scan_time).nanoseconds >= 500_000_000

    def tick(self):
        """Publish a command."""
        command = Twist()
        weak = self.charge is not None and self.charge < self.read('battery_threshold')
        if not weak and not self.is_blind():
            near, far = self.read('safety_distance'), self.read('slow_distance')
            if self.distance >= far:
                command.linear.x = self.read('max_linear_velocity')
            elif self.distance > near:
                command.linear.x = self.read('max_linear_velocity') * (self.distance - near) / (far - near)
        self.publisher.publish(command)


def main(args=None):
    """Create the node and its parts, and spin."""
    rclpy.init(args=args)
    try:
        node = rclpy.create_node('configured_node')
        declare_configuration(node)
        driver = Driver(node)
        node.add_post_set_parameters_callback(RateKeeper(node, driver.tick))
        node.add_on_set_parameters_callback(Validator(driver.read))
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
