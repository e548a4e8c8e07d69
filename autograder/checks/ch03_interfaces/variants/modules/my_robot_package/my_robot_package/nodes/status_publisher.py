"""A node that delegates: sensors write to a snapshot, and the answers come from a module without ROS."""

from dataclasses import dataclass, field

from my_robot_interfaces.msg import RobotStatus
from my_robot_interfaces.srv import CheckTrip
from my_robot_package.trips import judge, whole_percent
import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from sensor_msgs.msg import BatteryState, JointState

LATCHED = QoSProfile(history=HistoryPolicy.KEEP_LAST, depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@dataclass
class Snapshot:
    """The newest of each sensor."""

    level: int | None = None
    charging: bool = False
    joints: list = field(default_factory=list)


class Summary:
    """Has a node, and is none."""

    def __init__(self, node):
        """Connect the node's ends."""
        self.now = Snapshot()
        self.clock = node.get_clock()
        self.name = node.declare_parameter("robot_name", "MyRobot01").get_parameter_value().string_value
        seconds = node.declare_parameter("status_period", 1.0).get_parameter_value().double_value
        self.out = node.create_publisher(RobotStatus, "robot_status", LATCHED)
        node.create_subscription(BatteryState, "battery_state", self.take_battery, 10)
        node.create_subscription(JointState, "joint_states", self.take_joints, 10)
        node.create_service(CheckTrip, "check_trip", self.serve)
        node.create_timer(seconds, self.tell)
        node.get_logger().info(f"Status of {self.name} every {seconds} s")

    def take_battery(self, message):
        """Keep level and state."""
        self.now.level = whole_percent(message.percentage)
        self.now.charging = message.power_supply_status == BatteryState.POWER_SUPPLY_STATUS_CHARGING

    def take_joints(self, message):
        """Keep the positions."""
        self.now.joints = message.position

    def tell(self):
        """Publish the snapshot."""
        message = RobotStatus(is_charging=self.now.charging, joint_positions=self.now.joints)
        if self.now.level is not None:
            message.battery_level = self.now.level
        message.robot_name = self.name
        message.header.stamp = self.clock.now().to_msg()
        self.out.publish(message)

    def serve(self, request, response):
        """Answer by the module's verdict."""
        verdict = judge(self.now.level, request.legs, request.reserve, CheckTrip.Request.METRES_PER_PERCENT)
        response.battery_at_end, response.reason = verdict.left, verdict.reason
        response.possible = not verdict.reason
        return response


def main(args=None):
    """Run it."""
    rclpy.init(args=args)
    node = Node("status_publisher")
    Summary(node)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
