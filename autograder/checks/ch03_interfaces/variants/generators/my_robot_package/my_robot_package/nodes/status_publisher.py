"""Publish a summary of the sensors: a small model, and a node that only passes messages on."""

import dataclasses
import math

from my_robot_interfaces import msg, srv
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_system_default
from sensor_msgs.msg import BatteryState, JointState

STATUS_QOS = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def battery_percent(battery):
    """Return the level in whole percent, halves rounded up."""
    if battery is None:
        return -1
    percent = 100.0 * battery.percentage
    if math.isnan(percent) or percent < 0.0 or percent > 100.0:
        return -1
    whole = int(percent)
    return whole + 1 if percent - whole >= 0.5 else whole


@dataclasses.dataclass
class Robot:
    """The newest sensor messages of the robot."""

    battery: object = None
    joints: tuple = ()

    @property
    def charging(self):
        return bool(self.battery) and self.battery.power_supply_status == 1

    def trip(self, legs, reserve):
        """Return (possible, battery_at_end, reason)."""
        level = battery_percent(self.battery)
        if level < 0:
            return False, -1, 'the battery level is not known'
        needed = 0.0
        for number, leg in enumerate(legs, start=1):
            if not 0.0 <= leg < math.inf:
                return False, -1, f'leg {number} is {leg}'
            needed += leg
        left = (level * 5.0 - needed) / 5.0
        at_end = max(0, math.floor(left))
        if left < 0.0:
            return False, at_end, f'{needed / 5.0:.2f} percent needed, {level} there'
        if at_end < reserve:
            return False, at_end, f'{at_end} percent is less than {reserve}'
        return True, at_end, ''


class StatusPublisher(Node):
    """Pass messages between the model and ROS."""

    def __init__(self, **kwargs):
        super().__init__('status_publisher', **kwargs)
        self._robot_name, self._period = self.read_parameters()
        self._robot = Robot()
        any_time = ReentrantCallbackGroup()
        self.create_service(srv.CheckTrip, 'check_trip', self.check_trip, callback_group=any_time)
        self.create_timer(self._period, self.publish_status, callback_group=any_time)
        self._publisher = self.create_publisher(msg.RobotStatus, 'robot_status', STATUS_QOS)
        self.create_subscription(JointState, 'joint_states', self.joint_callback, 10)
        self.create_subscription(BatteryState, 'battery_state', self.battery_callback, 10)
        self.publish_status()
        self.get_logger().info(f'Status of {self._robot_name} every {self._period:g} s')

    def read_parameters(self):
        """Return robot_name and status_period (s); both are read once, at the start."""
        name = self.declare_parameter(
            'robot_name',
            'MyRobot01',
            ParameterDescriptor(description='who is speaking', read_only=True),
        )
        period = self.declare_parameter(
            'status_period',
            1.0,
            ParameterDescriptor(
                description='time between two status messages, in seconds',
                floating_point_range=[FloatingPointRange(from_value=0.05, to_value=60.0)],
                read_only=True,
            ),
        )
        return name.value, period.value

    def battery_callback(self, msg):
        if msg.power_supply_health == BatteryState.POWER_SUPPLY_HEALTH_DEAD:
            self.get_logger().warning('the battery is dead')
        self._robot.battery = msg

    def joint_callback(self, msg):
        self._robot.joints = tuple(msg.position)

    def publish_status(self):
        status = msg.RobotStatus()
        status.header.stamp = self.get_clock().now().to_msg()
        status.robot_name = self._robot_name
        status.battery_level = battery_percent(self._robot.battery)
        status.is_charging = self._robot.charging
        status.joint_positions.extend(self._robot.joints)
        self._publisher.publish(status)

    async def check_trip(self, request, response):
        response.possible, response.battery_at_end, response.reason = self._robot.trip(
            request.legs, request.reserve)
        return response


def main(args=None):
    """Run the node until SIGINT (Ctrl-C) or SIGTERM, then end with exit status 0."""
    rclpy.init(args=args)
    node = None
    try:
        node = StatusPublisher()
        rclpy.spin(node, executor=None)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except RuntimeError:
        if rclpy.ok():  # if not, a signal came between two waits, and rclpy raised this
            raise
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
