"""Beat five times a second."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import UInt32


class Beat(Node):
    """Counts its beats."""

    def __init__(self):
        super().__init__("beat")
        self.count = 0
        self.publisher = self.create_publisher(UInt32, "beat", 10)
        self.create_timer(0.2, self.on_timer)

    def on_timer(self):
        """Publish the number of the beat; the first one is 1."""
        self.count += 1
        self.publisher.publish(UInt32(data=self.count))


def main():
    """Beat until the node is stopped."""
    rclpy.init()
    node = Beat()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
