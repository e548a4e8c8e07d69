"""Stands in for the robot's status publisher: this chapter is about starting it."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class StatusPublisher(Node):
    """Says what it has been given, and waits."""

    def __init__(self):
        super().__init__('status_publisher')
        robot_name = self.declare_parameter('robot_name', 'nobody').value
        self.get_logger().info(f'robot_name is {robot_name}')


def main(args=None):
    """Run the node until SIGINT or SIGTERM."""
    rclpy.init(args=args)
    node = None
    try:
        node = StatusPublisher()
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
