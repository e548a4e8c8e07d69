"""The smoother with a lock and a coroutine."""

from collections import deque
import math
import threading

from motor_guard_interfaces.msg import Temperature
from rcl_interfaces.msg import IntegerRange, ParameterDescriptor
import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor


def build_node():
    """Return a new node."""
    node = rclpy.create_node('smoother')
    limits = [IntegerRange(from_value=1, to_value=100)]
    size = node.declare_parameter('window', 5, ParameterDescriptor(integer_range=limits)).value
    publisher = node.create_publisher(Temperature, 'smoothed', 10)
    lock, newest = threading.Lock(), deque()

    async def on_reading(reading):
        if not math.isfinite(reading.celsius):
            return
        with lock:
            newest.append(reading.celsius)
            if len(newest) > size:
                newest.popleft()
            mean = math.fsum(newest) / len(newest)
            publisher.publish(Temperature(stamp=reading.stamp, celsius=mean))

    node.create_subscription(Temperature, 'temperature', on_reading, 10, callback_group=ReentrantCallbackGroup())
    return node


def main(args=None):
    """Run the node with two threads."""
    rclpy.init(args=args)
    executor = MultiThreadedExecutor(num_threads=2)
    executor.add_node(build_node())
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
