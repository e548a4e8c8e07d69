"""A controller without a class: each scan is judged as it comes, and a watchdog forgets the verdict."""

import math
import threading

from geometry_msgs.msg import Twist, Vector3
import numpy as np
import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.qos import HistoryPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String

LIDAR = QoSProfile(history=HistoryPolicy.KEEP_LAST, depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


def stop():
    """Stand still."""
    return Twist()


def forward():
    """Drive straight on."""
    return Twist(linear=Vector3(x=0.3))


def left():
    """Turn on the spot."""
    return Twist(angular=Vector3(z=0.5))


def verdict(scan):
    """Return which of the three functions above a scan asks for."""
    readings = np.asarray(scan.ranges)
    bearings = scan.angle_min + scan.angle_increment * np.arange(readings.size)
    ahead = readings[np.cos(bearings) >= math.cos(math.pi / 6) - 1e-9]
    too_near = np.isneginf(ahead).any()
    free = np.isposinf(ahead).any()
    distances = ahead[(ahead >= scan.range_min) & (ahead <= scan.range_max)]
    if too_near or (distances < 1.0).any():
        return left
    return forward if free or distances.size else stop


def assemble(node):
    """Wire a node: a scan sets the verdict, the watchdog takes it back, the heart beats it out."""
    lock, now = threading.Lock(), {"do": stop}

    def decide(what):
        with lock:
            now["do"] = what

    def on_scan(scan):
        watchdog.reset()
        what = verdict(scan)
        decide(what)
        if what is left:
            node.get_logger().warning("Something is in the way", throttle_duration_sec=1.0)

    def beat():
        with lock:
            command = now["do"]()
        commands.publish(command)

    commands = node.create_publisher(Twist, "cmd_vel", 1)
    watchdog = node.create_timer(0.5, lambda: decide(stop), callback_group=MutuallyExclusiveCallbackGroup())
    node.create_subscription(LaserScan, "scan", on_scan, LIDAR, callback_group=MutuallyExclusiveCallbackGroup())
    node.create_subscription(String, "status", lambda said: node.get_logger().info(said.data), 10)
    node.create_timer(1 / 10, beat, callback_group=MutuallyExclusiveCallbackGroup())
    return node


def main():
    """Spin two threads until somebody asks for the end."""
    rclpy.init()
    executor = MultiThreadedExecutor(num_threads=2)
    executor.add_node(assemble(rclpy.create_node("robot_controller")))
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
