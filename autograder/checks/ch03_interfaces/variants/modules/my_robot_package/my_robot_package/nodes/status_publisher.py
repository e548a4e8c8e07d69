"""A status publisher that stores sensor data and computes answers in a module without ROS."""

from dataclasses import dataclass, field

from my_robot_interfaces.msg import RobotStatus
from my_robot_interfaces.srv import CheckTrip
from my_robot_package.trips import check_trip, whole_percent
import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from sensor_msgs.msg import BatteryState, JointState

LATCHED = QoSProfile(history=HistoryPolicy.KEEP_LAST, depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@dataclass
class Snapshot:
    """The latest data from each sensor."""

    level: int | None = None
    charging: bool = False
    joints: list = field(default_factory=list)


class StatusPublisher:
    """The status publisher around a node."""

    def __init__(self, node):
        """Add parameters, topics, the service and the timer to a node."""
        self.snapshot = Snapshot()
        self.clock = node.get_clock()
        self.name = node.declare_parameter("robot_name", "MyRobot01").get_parameter_value().string_value
        seconds = node.declare_parameter("status_period", 1.0).get_parameter_value().double_value
        self.publisher = node.create_publisher(RobotStatus, "robot_status", LATCHED)
        node.create_subscription(BatteryState, "battery_state", self.battery_callback, 10)
        node.create_subscription(JointState, "joint_states", self.joint_callback, 10)
        node.create_service(CheckTrip, "check_trip", self.answer)
        node.create_timer(seconds, self.publish_status)
        node.get_logger().info(f"Status of {self.name} every {seconds} s")

    def battery_callback(self, message):
        """Store the level and whether the battery is charging."""
        self.snapshot.level = whole_percent(message.percentage)
        self.snapshot.charging = message.power_supply_status == BatteryState.POWER_SUPPLY_STATUS_CHARGING

    def joint_callback(self, message):
        """Store the joints' positions."""
        self.snapshot.joints = message.position

    def publish_status(self):
        """Publish the snapshot."""
        message = RobotStatus(is_charging=self.snapshot.charging, joint_positions=self.snapshot.joints)
        if self.snapshot.level is not None:
            message.battery_level = self.snapshot.level
        message.robot_name = self.name
        message.header.stamp = self.clock.now().to_msg()
        self.publisher.publish(message)

    def answer(self, request, response):
        """Answer with the verdict of the module trips."""
        verdict = check_trip(self.snapshot.level, request.legs, request.reserve, CheckTrip.Request.METRES_PER_PERCENT)
        response.battery_at_end, response.reason = verdict.at_end, verdict.reason
        response.possible = not verdict.reason
        return response


def main(args=None):
    """Run the node."""
    rclpy.init(args=args)
    node = Node("status_publisher")
    StatusPublisher(node)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
