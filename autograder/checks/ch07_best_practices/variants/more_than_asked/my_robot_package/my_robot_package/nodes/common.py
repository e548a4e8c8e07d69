"""A main function that all nodes of this package share."""

import rclpy
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor


def run_node(factory, args):
    """Spin the node that factory() returns with two threads until it is interrupted."""
    rclpy.init(args=args)
    try:
        node = factory()
        try:
            executor = MultiThreadedExecutor(num_threads=2)
            executor.add_node(node)
            executor.spin()
        finally:
            node.destroy_node()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except RuntimeError:
        if rclpy.ok():
            raise
    finally:
        rclpy.try_shutdown()
