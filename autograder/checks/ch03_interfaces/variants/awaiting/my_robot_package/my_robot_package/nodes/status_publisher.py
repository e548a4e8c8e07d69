"""The status publisher as functions around a plain node."""

from functools import partial
import math

from my_robot_interfaces.msg import RobotStatus
from my_robot_interfaces.srv import CheckTrip
import rclpy
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy
from sensor_msgs.msg import BatteryState, JointState


def percent(battery):
    """Return the level in whole percent, or -1 if it is unknown."""
    charge = battery.percentage if battery is not None else math.nan
    if math.isnan(charge) or charge < 0 or charge > 1:
        return -1
    return int(charge * 100 + 0.5)


def report(node, newest, name, publisher):
    """Publish the status."""
    battery = newest.get(BatteryState)
    joints = newest.get(JointState)
    charging = battery and battery.power_supply_status == battery.POWER_SUPPLY_STATUS_CHARGING
    status = RobotStatus(robot_name=name, battery_level=percent(battery), is_charging=bool(charging))
    status.header.frame_id = "base_link"
    status.header.stamp = node.get_clock().now().to_msg()
    status.joint_positions = joints.position if joints else []
    publisher.publish(status)


def answer(newest, request, response):
    """Answer whether a trip is possible."""
    level = percent(newest.get(BatteryState))
    if level < 0:
        response.reason = "no battery has been heard of"
        return response
    if any(math.isnan(leg) or math.isinf(leg) or leg < 0 for leg in request.legs):
        response.reason = "no such leg"
        return response
    left = math.floor(level - sum(request.legs) / request.METRES_PER_PERCENT)
    enough = left >= max(0, request.reserve)
    return CheckTrip.Response(possible=enough, battery_at_end=max(0, left), reason="" if enough else "too far")


def main():
    """Run the node on two threads; its callbacks are still mutually exclusive."""
    rclpy.init()
    node = rclpy.create_node("status_publisher")
    name = node.declare_parameter("robot_name", "MyRobot01").value
    period = node.declare_parameter("status_period", 1.0).value
    newest = {}
    for kind, topic in ((BatteryState, "battery_state"), (JointState, "joint_states")):
        node.create_subscription(kind, topic, partial(newest.__setitem__, kind), 10)
    publisher = node.create_publisher(
        RobotStatus,
        "robot_status",
        QoSProfile(depth=1, reliability=QoSReliabilityPolicy.RELIABLE, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL),
    )
    node.create_service(CheckTrip, "check_trip", partial(answer, newest))
    node.create_timer(period, partial(report, node, newest, name, publisher))
    executor = MultiThreadedExecutor(num_threads=2)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
