"""A node beside its parts: a judge, a clockwork and a pilot, joined in main."""

from geometry_msgs.msg import Twist
from my_robot_package.configuration import contradiction, declare_configuration
from rcl_interfaces.msg import SetParametersResult
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import BatteryState, LaserScan


class Judge:
    """Says whether a request may pass."""

    def __init__(self, read):
        """Keep how to read a present value."""
        self.read = read

    def __call__(self, parameters):
        """Judge a request."""
        future = {name: self.read(name) for name in ('safety_distance', 'slow_distance')}
        for parameter in parameters:
            if parameter.name in future:
                future[parameter.name] = parameter.value
        problem = contradiction(**future)
        answer = SetParametersResult()
        answer.successful, answer.reason = not problem, problem
        return answer


class Clockwork:
    """Ticks at a frequency that may change."""

    def __init__(self, node, tick):
        """Start at the parameter's frequency."""
        self.node, self.tick = node, tick
        self.start(node.get_parameter('control_frequency').value)

    def start(self, frequency):
        """Tick at this frequency from now on."""
        self.timer = self.node.create_timer(1.0 / frequency, self.tick)

    def __call__(self, parameters):
        """Change to a new timer where the frequency has changed."""
        for parameter in parameters:
            if parameter.name == 'control_frequency':
                self.timer.cancel()
                self.node.destroy_timer(self.timer)
                self.start(parameter.value)


class Pilot:
    """Sees, and drives."""

    def __init__(self, node):
        """Connect."""
        self.node, self.read = node, lambda name: node.get_parameter(name).value
        self.last, self.seen_at, self.charge = None, None, None
        self.publisher = node.create_publisher(Twist, 'cmd_vel', 10)
        node.create_subscription(LaserScan, 'scan', self.see, qos_profile_sensor_data)
        node.create_subscription(BatteryState, 'battery_state', self.feel, qos_profile_sensor_data)

    def see(self, scan):
        """Keep the distance ahead and its time."""
        self.last = scan.ranges[round((0.0 - scan.angle_min) / scan.angle_increment)]
        self.seen_at = self.node.get_clock().now()

    def feel(self, battery):
        """Keep the charge."""
        self.charge = battery.percentage * 100.0

    def blind(self):
        """Return whether the last look is too old."""
        return self.seen_at is None or (self.node.get_clock().now() - self.seen_at).nanoseconds >= 500_000_000

    def tick(self):
        """Publish a command."""
        command = Twist()
        weak = self.charge is not None and self.charge < self.read('battery_threshold')
        if not weak and not self.blind():
            near, far = self.read('safety_distance'), self.read('slow_distance')
            if self.last >= far:
                command.linear.x = self.read('max_linear_velocity')
            elif self.last > near:
                command.linear.x = self.read('max_linear_velocity') * (self.last - near) / (far - near)
        self.publisher.publish(command)


def main(args=None):
    """Join the parts."""
    rclpy.init(args=args)
    try:
        node = rclpy.create_node('configured_node')
        declare_configuration(node)
        pilot = Pilot(node)
        node.add_post_set_parameters_callback(Clockwork(node, pilot.tick))
        node.add_on_set_parameters_callback(Judge(pilot.read))
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
