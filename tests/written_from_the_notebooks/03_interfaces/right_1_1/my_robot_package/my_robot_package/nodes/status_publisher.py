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

"""The robot's status, and a judgement of trips, from what its sensors say."""

from math import isfinite

from my_robot_interfaces.msg import RobotStatus
from my_robot_interfaces.srv import CheckTrip
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import BatteryState, JointState

STATUS_QOS = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)

UNKNOWN = RobotStatus.BATTERY_UNKNOWN


def battery_percent(battery):
    """Return the whole percent of a BatteryState, or BATTERY_UNKNOWN."""
    if battery is None:
        return UNKNOWN
    share = battery.percentage
    if share >= 0.0 and share <= 1.0:
        whole, rest = divmod(share * 100.0, 1.0)
        return int(whole) + (1 if rest >= 0.5 else 0)
    return UNKNOWN


def judge(level, legs, reserve):
    """Return battery_at_end, and a reason against the trip: empty when there is none."""
    if level == UNKNOWN:
        return UNKNOWN, 'nobody knows how full the battery is: its level is unknown'
    for number, leg in enumerate(legs, start=1):
        if not isfinite(leg) or leg < 0.0:
            return UNKNOWN, f'leg {number} is no distance that can be driven'
    needed = sum(legs) / CheckTrip.Request.METRES_PER_PERCENT
    if needed > level:
        return 0, f'the trip needs more than the {level} % that the battery has'
    left = int(level - needed)
    if left < reserve:
        return left, f'{left} % at the end are less than the reserve of {reserve} %'
    return left, ''


class StatusPublisher(Node):
    """Publishes robot_status and serves check_trip."""

    def __init__(self, **kwargs):
        """Create the node's endpoints and its timer."""
        super().__init__('status_publisher', **kwargs)
        self.robot_name, period = self.read_parameters()
        self.battery = self.joints = None
        self.create_subscription(JointState, 'joint_states', self.joint_callback, 10)
        self.create_subscription(BatteryState, 'battery_state', self.battery_callback, 10)
        self.publisher = self.create_publisher(RobotStatus, 'robot_status', STATUS_QOS)
        self.service = self.create_service(CheckTrip, 'check_trip', self.check_trip)
        self.timer = self.create_timer(period, self.publish_status)
        self.get_logger().info('Status of %s every %g s' % (self.robot_name, period))

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
        """Keep the message."""
        self.battery = msg

    def joint_callback(self, msg):
        """Keep the message."""
        self.joints = msg

    def publish_status(self):
        """Publish what is known at this moment."""
        status = RobotStatus(
            robot_name=self.robot_name, battery_level=battery_percent(self.battery))
        if self.battery:
            charging = BatteryState.POWER_SUPPLY_STATUS_CHARGING
            status.is_charging = self.battery.power_supply_status == charging
        if self.joints:
            status.joint_positions = list(self.joints.position)
        status.header.stamp = self.get_clock().now().to_msg()
        self.publisher.publish(status)

    def check_trip(self, request, response):
        """Answer whether the battery lasts."""
        response.battery_at_end, response.reason = judge(
            battery_percent(self.battery), request.legs, request.reserve)
        response.possible = not response.reason
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
