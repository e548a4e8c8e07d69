# Copyright 2026 The ROS 2 Python Course Authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""A summary of the robot for people, made of what its drivers publish."""

from decimal import Decimal, ROUND_HALF_UP
import math

from my_robot_interfaces.msg import RobotStatus
from my_robot_interfaces.srv import CheckTrip
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import BatteryState, JointState

# A node that joins late gets the last status immediately if it asks for the same durability.
STATUS_QOS = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def battery_percent(battery):
    """Return the charge, rounded to whole percent, or BATTERY_UNKNOWN."""
    percent = math.nan if battery is None else 100.0 * battery.percentage
    if not 0.0 <= percent <= 100.0:
        return RobotStatus.BATTERY_UNKNOWN
    return int(Decimal(percent).to_integral_value(rounding=ROUND_HALF_UP))


class Refusal(Exception):
    """A trip is not possible; the text says why."""

    def __init__(self, why, left=-1):
        super().__init__(why)
        self.left = left


def battery_after(level, legs, reserve):
    """Return the percent at the end of a possible trip; raise a Refusal for any other."""
    if level < 0:
        raise Refusal('unknown battery level')
    if any(math.isnan(leg) or math.isinf(leg) or leg < 0 for leg in legs):
        raise Refusal('a leg is negative, or not a number, or has no end')
    rest = level - sum(legs) / CheckTrip.Request.METRES_PER_PERCENT
    left = math.floor(rest) if rest > 0.0 else 0
    if rest < 0.0:
        raise Refusal('it needs more charge than there is', left)
    if left < reserve:
        raise Refusal(f'too little is left: {left} %', left)
    return left


class StatusPublisher(Node):
    """The robot_status and the service check_trip."""

    def __init__(self, **kwargs):
        """Name the node; create its publisher, subscriptions, service and timer."""
        super().__init__('status_publisher', **kwargs)
        self.robot_name, period = self.read_parameters()
        self.battery = None
        self.charging = False
        self.joints = []
        self.publisher = self.create_publisher(RobotStatus, 'robot_status', STATUS_QOS)
        for kind, topic, callback in (
            (BatteryState, 'battery_state', self.battery_callback),
            (JointState, 'joint_states', self.joint_callback),
        ):
            self.create_subscription(kind, topic, callback, 10)
        self.create_service(CheckTrip, 'check_trip', self.check_trip)
        self.create_timer(period, self.publish_status)
        self.get_logger().info(f'Status of {self.robot_name} every {period} s')

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
        """Keep the battery, and whether it charges."""
        self.battery = msg
        self.charging = msg.power_supply_status == BatteryState.POWER_SUPPLY_STATUS_CHARGING

    def joint_callback(self, msg):
        """Keep the positions."""
        self.joints = [float(position) for position in msg.position]

    def publish_status(self):
        """Put the status together, and publish it."""
        msg = RobotStatus(
            robot_name=self.robot_name,
            battery_level=battery_percent(self.battery),
            is_charging=self.charging,
            joint_positions=self.joints,
        )
        msg.header.stamp = self.get_clock().now().to_msg()
        self.publisher.publish(msg)

    def check_trip(self, request, response):
        """Fill in the response: possible until something speaks against it."""
        level = battery_percent(self.battery)
        try:
            response.battery_at_end = battery_after(level, request.legs, request.reserve)
        except Refusal as refusal:
            response.possible = False
            response.battery_at_end = refusal.left
            response.reason = str(refusal)
        else:
            response.possible = True
            response.reason = ''
        return response


def main(args=None):
    """Run the node until SIGINT (Ctrl-C) or SIGTERM, then end with exit status 0."""
    rclpy.init(args=args)
    node = None
    try:
        node = StatusPublisher()
        rclpy.spin(node)
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
