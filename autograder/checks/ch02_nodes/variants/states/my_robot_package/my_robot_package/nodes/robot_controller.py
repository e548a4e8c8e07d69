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
    """What the robot does: its speed in m/s, its rate of turn in rad/s."""

    BLIND = (0.0, 0.0)
    CRUISING = (0.3, 0.0)
    TURNING = (0.0, 0.5)


def state_of(clearance):
    """Return the state that fits what is in front."""
    if clearance is None:
        return State.BLIND
    return State.TURNING if clearance < SAFETY_DISTANCE else State.CRUISING


class RobotController(Node):
    """Turn the newest lidar scan into a velocity command, ten times a second."""

    def __init__(self, **kwargs):
        super().__init__('robot_controller', **kwargs)
        self.state = State.BLIND
        self.look = lambda: None
        self.create_subscription(
            LaserScan, 'scan', self.scan_callback, qos_profile_sensor_data)
        self.create_subscription(String, 'status', self.status_callback, 10)
        self.publisher = self.create_publisher(Twist, 'cmd_vel', 10)
        self.timer = self.create_timer(CONTROL_PERIOD, self.control_loop)

    def scan_callback(self, msg):
        """Keep the scan as the way to look at it, for as long as it is fresh."""
        stale = self.get_clock().now() + SCAN_TIMEOUT

        def look():
            return None if self.get_clock().now() > stale else forward_clearance(msg)

        self.look = look

    def status_callback(self, msg):
        """Log what was said."""
        self.get_logger().info('status: %s' % msg.data)

    def control_loop(self):
        """Go to the state that fits, and publish its command."""
        before, self.state = self.state, state_of(self.current_clearance())
        if self.state is not before:
            self.get_logger().debug(f'{before.name} -> {self.state.name}')
        if self.state is State.TURNING:
            self.get_logger().warning('in the way', throttle_duration_sec=1.0)
        command = Twist()
        command.linear.x, command.angular.z = self.state.value
        self.publisher.publish(command)

    def current_clearance(self):
        """Return what is in front now, or None without a fresh scan."""
        return self.look()


def main(args=None):
    """Run the node until it is told to end."""
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
