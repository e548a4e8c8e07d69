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

"""Say how the robot is, now and then, and whether it can go on a trip, when asked."""

from math import floor, fsum, inf, isfinite

from my_robot_interfaces.msg import RobotStatus
from my_robot_interfaces.srv import CheckTrip
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import BatteryState, JointState
from std_msgs.msg import Header

STATUS_QOS = QoSProfile(
    history=HistoryPolicy.KEEP_LAST,
    depth=1,
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
)


class ImpossibleTrip(Exception):
    """Why a trip cannot be made, and what the battery would have at its end."""

    def __init__(self, reason, battery_at_end=RobotStatus.BATTERY_UNKNOWN):
        super().__init__(reason)
        self.battery_at_end = battery_at_end


def battery_percent(battery):
    """
    Return a BatteryState's charge in whole percent, 0 to 100, or BATTERY_UNKNOWN.

    It is unknown when battery is None, or when its percentage is nan or outside of 0 to 1.
    """
    try:
        share = float(battery.percentage)
    except AttributeError:
        return RobotStatus.BATTERY_UNKNOWN
    return int(share * 100 + 0.5) if 0 <= share <= 1 else RobotStatus.BATTERY_UNKNOWN


def charge_for(legs):
    """Return how many percent the legs of a trip take; more than a float can hold is inf."""
    if any(leg < 0 or not isfinite(leg) for leg in legs):
        raise ImpossibleTrip('a leg is not a distance in metres')
    try:
        metres = fsum(legs)
    except OverflowError:
        metres = inf
    return metres / CheckTrip.Request.METRES_PER_PERCENT


class StatusPublisher(Node):
    """Publishes robot_status, and serves check_trip."""

    def __init__(self, **kwargs):
        """Name the node status_publisher; create its publisher, subscriptions, service and timer."""
        super().__init__('status_publisher', **kwargs)
        self.robot_name, self.period = self.read_parameters()
        self.battery, self.joints = None, None
        self.publisher = self.create_publisher(RobotStatus, 'robot_status', STATUS_QOS)
        for kind, topic, callback in (
            (BatteryState, 'battery_state', self.battery_callback),
            (JointState, 'joint_states', self.joint_callback),
        ):
            self.create_subscription(kind, topic, callback, QoSProfile(depth=10))
        self.create_service(CheckTrip, 'check_trip', self.check_trip)
        self.create_timer(self.period, self.publish_status)
        self.get_logger().info(f'Status of {self.robot_name} every {self.period} s')

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

    def charging(self):
        """Return whether the battery says that it is being charged."""
        charging = BatteryState.POWER_SUPPLY_STATUS_CHARGING
        return bool(self.battery) and self.battery.power_supply_status == charging

    def publish_status(self):
        """Publish what is known now; what was never heard of stays unknown or empty."""
        self.publisher.publish(RobotStatus(
            header=Header(stamp=self.get_clock().now().to_msg()),
            robot_name=self.robot_name,
            battery_level=battery_percent(self.battery),
            is_charging=self.charging(),
            joint_positions=[*self.joints.position] if self.joints is not None else [],
        ))

    def check_trip(self, request, response):
        """Fill in whether the battery would last for a trip, and return the response."""
        try:
            response.battery_at_end = self.battery_after(request.legs, request.reserve)
        except ImpossibleTrip as trip:
            response.possible = False
            response.battery_at_end = trip.battery_at_end
            response.reason = str(trip)
        else:
            response.possible = True
            response.reason = ''
        return response

    def battery_after(self, legs, reserve):
        """Return the percent left after a trip; raise ImpossibleTrip when it is too long."""
        level = battery_percent(self.battery)
        if level < 0:
            raise ImpossibleTrip('nobody knows how full the battery is')
        used = charge_for(legs)
        if level < used:
            raise ImpossibleTrip('the battery would be empty on the way', 0)
        left = floor(level - used)
        if left < reserve:
            raise ImpossibleTrip('it would eat into the reserve', left)
        return left


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
