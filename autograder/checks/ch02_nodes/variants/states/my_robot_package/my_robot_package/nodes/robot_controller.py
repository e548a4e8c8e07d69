"""A robot controller that is always in one of three states."""

from enum import Enum

from geometry_msgs.msg import Twist
from my_robot_package.nodes.lidar import forward_clearance
import rclpy
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String

CONTROL_PERIOD = 0.1
SAFETY_DISTANCE = 1.0
SCAN_TIMEOUT = Duration(seconds=0.5)


class State(Enum):
    """A behaviour of the robot: its speed in m/s and its turn rate in rad/s."""

    BLIND = (0.0, 0.0)
    CRUISING = (0.3, 0.0)
    TURNING = (0.0, 0.5)


def state_of(clearance):
    """Return the state for a clearance."""
    if clearance is None:
        return State.BLIND
    return State.TURNING if clearance < SAFETY_DISTANCE else State.CRUISING


class RobotController(Node):
    """Turn the newest lidar scan into a velocity command, ten times a second."""

    def __init__(self, **kwargs):
        super().__init__('robot_controller', **kwargs)
        self.state = State.BLIND
        self.measure = lambda: None
        self.create_subscription(
            LaserScan, 'scan', self.scan_callback, qos_profile_sensor_data)
        self.create_subscription(String, 'status', self.status_callback, 10)
        self.publisher = self.create_publisher(Twist, 'cmd_vel', 10)
        self.timer = self.create_timer(CONTROL_PERIOD, self.control_loop)

    def scan_callback(self, msg):
        """Store the scan as a function that returns its clearance while it is fresh."""
        expiry = self.get_clock().now() + SCAN_TIMEOUT

        def measure():
            return None if self.get_clock().now() > expiry else forward_clearance(msg)

        self.measure = measure

    def status_callback(self, msg):
        """Log the status."""
        self.get_logger().info('status: %s' % msg.data)

    def control_loop(self):
        """Enter the state for the current clearance, and publish its command."""
        previous, self.state = self.state, state_of(self.current_clearance())
        if self.state is not previous:
            self.get_logger().debug(f'{previous.name} -> {self.state.name}')
        if self.state is State.TURNING:
            self.get_logger().warning('in the way', throttle_duration_sec=1.0)
        command = Twist()
        command.linear.x, command.angular.z = self.state.value
        self.publisher.publish(command)

    def current_clearance(self):
        """Return the current clearance, or None without a fresh scan."""
        return self.measure()


def main(args=None):
    """Run the node until Ctrl-C or SIGTERM."""
    rclpy.init(args=args)
    node = None
    try:
        node = RobotController()
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except RuntimeError:
        if rclpy.ok():
            raise
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
