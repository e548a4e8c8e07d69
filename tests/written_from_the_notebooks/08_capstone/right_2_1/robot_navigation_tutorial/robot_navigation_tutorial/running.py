"""How each program of this package starts and ends."""

import rclpy
from rclpy.executors import ExternalShutdownException


def run(make_node, args=None):
    """Spin the node that make_node() returns until SIGINT or SIGTERM; no traceback then."""
    rclpy.init(args=args)
    node = None
    try:
        node = make_node()
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except RuntimeError:
        if rclpy.ok():  # if not, a signal came between two waits, and rclpy raised this
            raise
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()
