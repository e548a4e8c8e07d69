"""The same node, with its times in nanoseconds."""

import sys

import rclpy
import speed_guard.limits
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import HistoryPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Range

SENSOR = QoSProfile(reliability=ReliabilityPolicy.BEST_EFFORT, history=HistoryPolicy.KEEP_LAST, depth=3)


class SpeedGuard(Node):
    """A node that limits the speed of commands."""

    def __init__(self, **kwargs):
        """Declare the parameters, and create the endpoints and the timer."""
        super().__init__("speed_guard", **kwargs)
        self.declare_parameters("", [("timeout", 0.5), ("slow_distance", 1.5), ("stop_distance", 0.5)])
        self.patience = int(self.get_parameter("timeout").value * 1e9)
        self.readings = []
        self.newest = None
        self.out = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Twist, "cmd_vel_raw", self.answer, 10)
        self.create_subscription(Range, "distance", self.measure, SENSOR)
        self.create_timer(0.04, self.check_silence)

    def nanoseconds(self):
        """Return the ROS time in nanoseconds."""
        return self.get_clock().now().nanoseconds

    def measure(self, reading):
        """Store the reading and its time."""
        self.readings = [(reading.range, self.nanoseconds())]

    def known_distance(self):
        """Return the current distance; None if it is too old or missing."""
        for value, received in self.readings:
            if self.nanoseconds() - received <= self.patience:
                return value
        return None

    def answer(self, command):
        """Publish the command with the allowed speed."""
        self.newest = self.nanoseconds()
        near = self.get_parameter("stop_distance").value
        far = self.get_parameter("slow_distance").value
        result = Twist(linear=command.linear, angular=command.angular)
        result.linear.x = speed_guard.limits.safe_speed(
            command.linear.x, self.known_distance(), stop_distance=near, slow_distance=far
        )
        self.out.publish(result)

    def check_silence(self):
        """Publish one stop command after a silence."""
        if self.newest is not None and self.nanoseconds() - self.newest > self.patience:
            self.out.publish(Twist())
            self.newest = None


def main(args=None):
    """Run the node until it is interrupted."""
    rclpy.init(args=args)
    executor = SingleThreadedExecutor()
    executor.add_node(SpeedGuard())
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except RuntimeError:
        if rclpy.ok():
            raise
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    sys.exit(main())
