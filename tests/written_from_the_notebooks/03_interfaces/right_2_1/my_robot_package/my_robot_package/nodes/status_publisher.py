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

"""The robot's state in a few numbers, and an answer to "does the battery last?"."""

import math
from typing import Iterable, Optional, Tuple

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


def battery_percent(battery: Optional[BatteryState]) -> int:
    """Return a BatteryState's charge in whole percent, 0 to 100, or BATTERY_UNKNOWN."""
    fraction = math.nan if battery is None else battery.percentage
    if math.isnan(fraction) or fraction < 0.0 or fraction > 1.0:
        return RobotStatus.BATTERY_UNKNOWN
    whole, rest = divmod(100.0 * fraction, 1.0)
    return int(whole) + (1 if rest >= 0.5 else 0)


def is_a_trip(legs: Iterable[float]) -> bool:
    """Return whether each leg is a number of metres that a robot can drive."""
    return not any(math.isnan(leg) or math.isinf(leg) or leg < 0.0 for leg in legs)


def judge(level: int, legs: Iterable[float], reserve: int) -> Tuple[bool, int, str]:
    """Return what the response says: possible, battery_at_end and reason."""
    if level == RobotStatus.BATTERY_UNKNOWN:
        return False, RobotStatus.BATTERY_UNKNOWN, 'battery: unknown'
    if not is_a_trip(legs):
        return False, RobotStatus.BATTERY_UNKNOWN, 'legs: negative or not finite'
    need = sum(legs) / CheckTrip.Request.METRES_PER_PERCENT
    if need > level:
        return False, 0, f'battery: the {level} % are not enough'
    end = int(level - need)  # not negative here, so this rounds down
    if end < reserve:
        return False, end, f'reserve: {end} % at the end are fewer than {reserve} %'
    return True, end, ''


class StatusPublisher(Node):
    """Publishes the robot's status at a steady rate, and judges trips by the battery."""

    def __init__(self, **kwargs):
        """Name the node status_publisher; create its publisher, subscriptions, service and timer."""
        super().__init__('status_publisher', **kwargs)
        self.battery = None
        self.joints = None
        self.robot_name, seconds = self.read_parameters()
        self.create_subscription(JointState, 'joint_states', self.joint_callback, 10)
        self.create_subscription(BatteryState, 'battery_state', self.battery_callback, 10)
        self.publisher = self.create_publisher(RobotStatus, 'robot_status', STATUS_QOS)
        self.service = self.create_service(CheckTrip, 'check_trip', self.check_trip)
        self.timer = self.create_timer(seconds, self.publish_status)
        self.get_logger().info('Status of %s every %g s' % (self.robot_name, seconds))

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
        """Keep the newest battery state."""
        self.battery = msg

    def joint_callback(self, msg):
        """Keep the newest joint positions."""
        self.joints = msg

    def publish_status(self):
        """Publish what is known now; what was never heard of stays unknown or empty."""
        charging, positions = False, []
        if self.battery:
            charging = (
                BatteryState.POWER_SUPPLY_STATUS_CHARGING == self.battery.power_supply_status)
        if self.joints:
            positions = list(self.joints.position)
        status = RobotStatus(
            robot_name=self.robot_name,
            battery_level=battery_percent(self.battery),
            is_charging=charging,
            joint_positions=positions,
        )
        status.header.stamp = self.get_clock().now().to_msg()
        self.publisher.publish(status)

    def check_trip(self, request, response):
        """Fill in whether the battery would last for a trip, and return the response."""
        response.possible, response.battery_at_end, response.reason = judge(
            battery_percent(self.battery), request.legs, request.reserve)
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
