"""A controller without a class: each scan selects a command, and a watchdog resets it."""

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
    """Return the command to stand still."""
    return Twist()


def forward():
    """Return the command to drive straight on."""
    return Twist(linear=Vector3(x=0.3))


def left():
    """Return the command to turn on the spot."""
    return Twist(angular=Vector3(z=0.5))


def choose_command(scan):
    """Return one of the three functions above for a scan."""
    readings = np.asarray(scan.ranges)
    bearings = scan.angle_min + scan.angle_increment * np.arange(readings.size)
    ahead = readings[np.cos(bearings) >= math.cos(math.pi / 6) - 1e-9]
    too_near = np.isneginf(ahead).any()
    free = np.isposinf(ahead).any()
    distances = ahead[(ahead >= scan.range_min) & (ahead <= scan.range_max)]
    if too_near or (distances < 1.0).any():
        return left
    return forward if free or distances.size else stop


def build(node):
    """Add the publisher, the subscriptions and the timers to a node."""
    lock, selected = threading.Lock(), {"command": stop}

    def select(make_command):
        with lock:
            selected["command"] = make_command

    def on_scan(scan):
        watchdog.reset()
        make_command = choose_command(scan)
        select(make_command)
        if make_command is left:
            node.get_logger().warning("Something is in the way", throttle_duration_sec=1.0)

    def publish_command():
        with lock:
            command = selected["command"]()
        commands.publish(command)

    commands = node.create_publisher(Twist, "cmd_vel", 1)
    watchdog = node.create_timer(0.5, lambda: select(stop), callback_group=MutuallyExclusiveCallbackGroup())
    node.create_subscription(LaserScan, "scan", on_scan, LIDAR, callback_group=MutuallyExclusiveCallbackGroup())
    node.create_subscription(String, "status", lambda status: node.get_logger().info(status.data), 10)
    node.create_timer(1 / 10, publish_command, callback_group=MutuallyExclusiveCallbackGroup())
    return node


def main():
    """Spin the node on two threads until Ctrl-C or SIGTERM."""
    rclpy.init()
    executor = MultiThreadedExecutor(num_threads=2)
    executor.add_node(build(rclpy.create_node("robot_controller")))
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
