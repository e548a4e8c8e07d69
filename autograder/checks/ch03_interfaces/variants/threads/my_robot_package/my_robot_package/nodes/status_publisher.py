"""The status publisher as a class of three mixins, spun in its own thread."""

import threading

from my_robot_interfaces.msg import RobotStatus
from my_robot_interfaces.srv import CheckTrip
import numpy as np
import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSDurabilityPolicy, QoSProfile
from sensor_msgs.msg import BatteryState, JointState

UNKNOWN = RobotStatus.BATTERY_UNKNOWN


class BatteryMixin:
    """Store the battery's level."""

    level, charges = UNKNOWN, False

    def on_battery(self, battery):
        """Store the level and whether the battery is charging."""
        share = np.float64(battery.percentage)
        known = bool(np.isfinite(share) and 0.0 <= share <= 1.0)
        self.level = int(np.floor(share * 100.0 + 0.5)) if known else UNKNOWN
        self.charges = battery.power_supply_status == battery.POWER_SUPPLY_STATUS_CHARGING


class JointMixin:
    """Store the joints' positions."""

    joints = np.zeros(0, dtype=np.float32)

    def on_joints(self, joints):
        """Store the positions as an array."""
        self.joints = np.asarray(joints.position, dtype=np.float32)


class TripMixin:
    """Answer whether a trip is possible."""

    def on_trip(self, request, response):
        """Answer a request with the legs as an array."""
        legs = np.asarray(request.legs, dtype=float)
        if self.level == UNKNOWN:
            response.reason = "battery level unknown"
        elif not np.all(np.isfinite(legs) & (legs >= 0.0)):
            response.reason = "legs must be finite and not negative"
        else:
            remaining = self.level - legs.sum() / request.METRES_PER_PERCENT
            response.battery_at_end = max(0, int(np.floor(remaining)))
            response.possible = bool(remaining >= 0.0) and response.battery_at_end >= request.reserve
            response.reason = "" if response.possible else "the battery would run low"
        return response


class StatusPublisher(BatteryMixin, JointMixin, TripMixin, Node):
    """The node with all mixins."""

    def __init__(self, **kwargs):
        """Declare parameters, and create topics, service and timer."""
        super().__init__("status_publisher", **kwargs)
        self.declare_parameters("", [("robot_name", "MyRobot01"), ("status_period", 1.0)])
        durable = QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
        self.status = self.create_publisher(RobotStatus, "robot_status", durable)
        self.create_subscription(BatteryState, "battery_state", self.on_battery, 10)
        self.create_subscription(JointState, "joint_states", self.on_joints, 10)
        self.create_service(CheckTrip, "check_trip", self.on_trip)
        self.create_timer(self.get_parameter("status_period").value, self.publish_status)

    def publish_status(self):
        """Publish the newest status."""
        message = RobotStatus(
            robot_name=self.get_parameter("robot_name").value,
            battery_level=self.level,
            is_charging=self.charges,
            joint_positions=self.joints,
        )
        message.header.stamp = self.get_clock().now().to_msg()
        self.status.publish(message)


def main():
    """Spin the node in a thread, and wait for its end."""
    rclpy.init()
    node = StatusPublisher()
    executor = SingleThreadedExecutor()
    executor.add_node(node)

    def spin():
        try:
            executor.spin()
        except ExternalShutdownException:
            pass

    spinner = threading.Thread(target=spin)
    spinner.start()
    try:
        while spinner.is_alive():
            spinner.join(0.2)
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()
        spinner.join()
