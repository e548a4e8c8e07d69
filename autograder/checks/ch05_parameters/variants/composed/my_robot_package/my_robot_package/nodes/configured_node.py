"""A plain node with functions around a settings object, without a class that derives from Node."""

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


def speed(settings, state, now):
    """Return the speed in m/s."""
    if state.distance is None or now - state.scan_time > BLIND_AFTER:
        return 0.0
    if state.charge is not None and state.charge < settings.battery_threshold:
        return 0.0
    near, far = settings.safety_distance, settings.slow_distance
    share = (state.distance - near) / (far - near)
    return settings.max_linear_velocity * max(0.0, min(1.0, share))


def build_node():
    """Return a new node with its callbacks."""
    node = rclpy.create_node("configured_node")
    declare_configuration(node)
    group = MutuallyExclusiveCallbackGroup()
    state = SimpleNamespace(distance=None, scan_time=0, charge=None)
    settings = SimpleNamespace(**{name: node.get_parameter(name).value for name in NAMES})
    publisher = node.create_publisher(Twist, "cmd_vel", 1)

    def tick():
        command = Twist()
        command.linear.x = speed(settings, state, node.get_clock().now().nanoseconds)
        publisher.publish(command)

    def start():
        return node.create_timer(1.0 / settings.control_frequency, tick, callback_group=group)

    timers = [start()]

    def on_scan(scan):
        ahead = scan.ranges[round(-scan.angle_min / scan.angle_increment)]
        if ahead == inf:
            ahead = 1e6
        state.distance = ahead if isfinite(ahead) else None
        state.scan_time = node.get_clock().now().nanoseconds

    def on_battery(battery):
        state.charge = 100 * battery.percentage

    def validate(parameters):
        proposed = SimpleNamespace(**vars(settings))
        for parameter in parameters:
            setattr(proposed, parameter.name, parameter.value)
        problem = contradiction(proposed.safety_distance, proposed.slow_distance)
        if problem:
            return SetParametersResult(successful=False, reason=problem)
        return SetParametersResult(successful=True)

    def apply(parameters):
        for parameter in parameters:
            if parameter.name in NAMES:
                setattr(settings, parameter.name, parameter.value)
        if any(parameter.name == "control_frequency" for parameter in parameters):
            node.destroy_timer(timers.pop())
            timers.append(start())

    node.create_subscription(LaserScan, "scan", on_scan, qos_profile_sensor_data, callback_group=group)
    node.create_subscription(BatteryState, "battery_state", on_battery, 10, callback_group=group)
    node.add_on_set_parameters_callback(validate)
    node.add_post_set_parameters_callback(apply)
    node.get_logger().info(node.get_parameter("robot_name").value)
    return node


def main(args=None):
    """Run the node with two threads."""
    rclpy.init(args=args)
    try:
        executor = MultiThreadedExecutor(num_threads=2)
        executor.add_node(build_node())
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
