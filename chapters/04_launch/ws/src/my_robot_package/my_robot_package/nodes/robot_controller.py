"""Stands in for the robot's controller: this chapter is about starting it."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class RobotController(Node):
    """Says what it has been given, and waits."""

    def __init__(self):
        super().__init__('robot_controller')
        max_linear_velocity = self.declare_parameter('max_linear_velocity', 0.1).value
        self.get_logger().info(f'max_linear_velocity is {max_linear_velocity}')


def main(args=None):
    """Run the node until SIGINT or SIGTERM."""
    rclpy.init(args=args)
    node = None
    try:
        node = RobotController()
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
