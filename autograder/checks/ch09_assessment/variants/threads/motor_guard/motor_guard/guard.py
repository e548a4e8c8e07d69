"""The guard with a queue of averages and a thread that decides."""

import math
import queue
import threading

from motor_guard_interfaces.msg import Decision, Temperature
import rclpy
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class Guard(Node):
    """A node that decides in a separate thread."""

    def __init__(self):
        """Check the thresholds, and start the thread."""
        super().__init__('guard')
        self.declare_parameters('', [('hot', 60.0), ('cool', 50.0)])
        self.hot, self.cool = (self.get_parameter(name).value for name in ('hot', 'cool'))
        if not self.cool < self.hot:
            raise RuntimeError('the guard cannot work with a cool that is not below hot')
        self.averages = queue.SimpleQueue()
        self.out = self.create_publisher(Decision, 'decision', 10)
        self.create_subscription(Temperature, 'smoothed', self.averages.put, 10)
        self.thread = threading.Thread(target=self.decide)
        self.thread.start()

    def decide(self):
        """Publish decisions until the queue contains None."""
        cooling = False
        for average in iter(self.averages.get, None):
            celsius = average.celsius
            cooling = not math.isfinite(celsius) or celsius >= self.hot or (cooling and celsius > self.cool)
            self.out.publish(Decision(stamp=average.stamp, cooling=cooling, celsius=celsius))


def main(args=None):
    """Run the node with two threads, and end the third one."""
    rclpy.init(args=args)
    node = Guard()
    executor = MultiThreadedExecutor(num_threads=2)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.averages.put(None)
        node.thread.join()
        rclpy.try_shutdown()
