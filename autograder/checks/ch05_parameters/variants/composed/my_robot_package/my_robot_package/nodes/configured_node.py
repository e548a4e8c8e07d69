"""The node as a few functions around a settings object; no class derives from Node."""

from math import inf, isfinite
from types import SimpleNamespace

import rclpy
from geometry_msgs.msg import Twist
from my_robot_package.configuration import contradiction, declare_configuration
from rcl_interfaces.msg import SetParametersResult
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import BatteryState, LaserScan

NAMES = ("max_linear_velocity", "safety_distance", "slow_distance", "control_frequency", "battery_threshold")
BLIND_AFTER = 500_000_000  # ns


def speed(settings, seen, now):
    """Return m/s."""
    if seen.distance is None or now - seen.when > BLIND_AFTER:
        return 0.0
    if seen.charge is not None and seen.charge < settings.battery_threshold:
        return 0.0
    near, far = settings.safety_distance, settings.slow_distance
    share = (seen.distance - near) / (far - near)
    return settings.max_linear_velocity * max(0.0, min(1.0, share))


def build():
    """Return the node, its callbacks around it."""
    node = rclpy.create_node("configured_node")
    declare_configuration(node)
    group = MutuallyExclusiveCallbackGroup()
    seen = SimpleNamespace(distance=None, when=0, charge=None)
    settings = SimpleNamespace(**{name: node.get_parameter(name).value for name in NAMES})
    publisher = node.create_publisher(Twist, "cmd_vel", 1)

    def tick():
        command = Twist()
        command.linear.x = speed(settings, seen, node.get_clock().now().nanoseconds)
        publisher.publish(command)

    def start():
        return node.create_timer(1.0 / settings.control_frequency, tick, callback_group=group)

    timers = [start()]

    def scanned(scan):
        ahead = scan.ranges[round(-scan.angle_min / scan.angle_increment)]
        if ahead == inf:
            ahead = 1e6
        seen.distance = ahead if isfinite(ahead) else None
        seen.when = node.get_clock().now().nanoseconds

    def charged(battery):
        seen.charge = 100 * battery.percentage

    def judge(parameters):
        future = SimpleNamespace(**vars(settings))
        for parameter in parameters:
            setattr(future, parameter.name, parameter.value)
        problem = contradiction(future.safety_distance, future.slow_distance)
        if problem:
            return SetParametersResult(successful=False, reason=problem)
        return SetParametersResult(successful=True)

    def act(parameters):
        for parameter in parameters:
            if parameter.name in NAMES:
                setattr(settings, parameter.name, parameter.value)
        if any(parameter.name == "control_frequency" for parameter in parameters):
            node.destroy_timer(timers.pop())
            timers.append(start())

    node.create_subscription(LaserScan, "scan", scanned, qos_profile_sensor_data, callback_group=group)
    node.create_subscription(BatteryState, "battery_state", charged, 10, callback_group=group)
    node.add_on_set_parameters_callback(judge)
    node.add_post_set_parameters_callback(act)
    node.get_logger().info(node.get_parameter("robot_name").value)
    return node


def main(args=None):
    """Run it in two threads."""
    rclpy.init(args=args)
    try:
        executor = MultiThreadedExecutor(num_threads=2)
        executor.add_node(build())
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
