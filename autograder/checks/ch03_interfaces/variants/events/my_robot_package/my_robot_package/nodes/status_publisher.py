"""The status publisher as closures over a dictionary, with its callbacks in a reentrant group."""

import math
import threading

from my_robot_interfaces.msg import RobotStatus
from my_robot_interfaces.srv import CheckTrip
import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from sensor_msgs.msg import BatteryState, JointState


def build():
    """Return the status publisher's node."""
    node = rclpy.create_node("status_publisher")
    group, lock = ReentrantCallbackGroup(), threading.Lock()
    newest = {"battery": BatteryState(percentage=math.nan), "joints": JointState()}
    name = node.declare_parameter("robot_name", "MyRobot01").value
    period = node.declare_parameter("status_period", 1.0).value
    qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    publisher = node.create_publisher(RobotStatus, "robot_status", qos)

    def store(key):
        def callback(message):
            with lock:
                newest[key] = message

        return callback

    def level():
        share = newest["battery"].percentage
        return math.floor(100.0 * share + 0.5) if 0.0 <= share <= 1.0 else RobotStatus.BATTERY_UNKNOWN

    def publish():
        with lock:
            status = RobotStatus(robot_name=name, battery_level=level())
            status.is_charging = newest["battery"].power_supply_status == BatteryState.POWER_SUPPLY_STATUS_CHARGING
            status.joint_positions = newest["joints"].position
        status.header.stamp = node.get_clock().now().to_msg()
        publisher.publish(status)

    def check(request, response):
        with lock:
            percent = level()
        if percent < 0 or any(leg < 0.0 or not math.isfinite(leg) for leg in request.legs):
            response.reason = "I cannot tell: a leg is no distance, or the battery is silent"
            return response
        metres = percent * request.METRES_PER_PERCENT - sum(request.legs)
        response.battery_at_end = max(0, math.floor(metres / request.METRES_PER_PERCENT))
        response.possible = metres >= 0.0 and response.battery_at_end >= request.reserve
        response.reason = "" if response.possible else "not without a charge on the way"
        return response

    node.create_subscription(BatteryState, "battery_state", store("battery"), 10, callback_group=group)
    node.create_subscription(JointState, "joint_states", store("joints"), qos_profile_sensor_data, callback_group=group)
    node.create_service(CheckTrip, "check_trip", check, callback_group=group)
    node.create_timer(period, publish, callback_group=group)
    node.get_logger().info(f"Status of {name} every {period} s")
    return node


def main():
    """Run the node on three threads."""
    rclpy.init()
    executor = MultiThreadedExecutor(num_threads=3)
    executor.add_node(build())
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
