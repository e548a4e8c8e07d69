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

"""Publish a summary of the robot's sensors, and judge whether its battery lasts for a trip."""

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
    """
    Return a BatteryState's charge in whole percent, 0 to 100, or BATTERY_UNKNOWN.

    A BatteryState's percentage goes from 0.0 to 1.0. The charge is unknown when battery is
    None, or when the percentage is nan or outside of that range.
    """
    if battery is None or not 0.0 <= battery.percentage <= 1.0:
        return RobotStatus.BATTERY_UNKNOWN  # BatteryState says nan when it does not know
    return math.floor(battery.percentage * 100.0 + 0.5)


class StatusPublisher(Node):
    """
    Publishes the robot's status at a steady rate, and judges trips by the battery.

    Publishes robot_status (my_robot_interfaces/RobotStatus), subscribes to battery_state
    (sensor_msgs/BatteryState) and joint_states (sensor_msgs/JointState), and serves
    check_trip (my_robot_interfaces/CheckTrip).
    """

    def __init__(self, **kwargs):
        """
        Name the node status_publisher; create its publisher, subscriptions, service and timer.

        The publisher uses STATUS_QOS, the subscriptions a queue of 10. The timer calls
        publish_status every status_period. At the end, log at level info 'Status of NAME every
        PERIOD s'. kwargs are passed on to Node, so that a test can pass a context of its own.
        """
        super().__init__('status_publisher', **kwargs)
        self.robot_name, period = self.read_parameters()
        self.battery = None
        self.joints = None
        self.publisher = self.create_publisher(RobotStatus, 'robot_status', STATUS_QOS)
        self.create_subscription(BatteryState, 'battery_state', self.battery_callback, 10)
        self.create_subscription(JointState, 'joint_states', self.joint_callback, 10)
        self.create_service(CheckTrip, 'check_trip', self.check_trip)
        self.create_timer(period, self.publish_status)
        self.get_logger().info(f'Status of {self.robot_name} every {period:g} s')

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
        """
        Publish the newest values; those that have not arrived yet stay unknown or empty.

        The stamp is the time of this call, by self.get_clock(). The robot is charging when the
        battery's power_supply_status says POWER_SUPPLY_STATUS_CHARGING.
        """
        msg = RobotStatus()
        msg.header.stamp = self.get_clock().now().to_msg()
        msg.robot_name = self.robot_name
        msg.battery_level = battery_percent(self.battery)
        msg.is_charging = (
            self.battery is not None
            and self.battery.power_supply_status == BatteryState.POWER_SUPPLY_STATUS_CHARGING
        )
        if self.joints is not None:
            msg.joint_positions = list(self.joints.position)  # float64 to float32
        self.publisher.publish(msg)
        self.get_logger().debug(f'Published the status of {msg.robot_name}')

    def check_trip(self, request, response):
        """
        Fill in whether the battery would last for a trip, and return the response.

        battery_at_end is the level from battery_percent minus the percent that the legs need,
        rounded down, and never below 0. The trip is possible when battery_at_end is at least the
        reserve, and the legs need no more than the level.

        When the battery's level is unknown, or a leg is negative or not finite, the trip is not
        possible and battery_at_end is BATTERY_UNKNOWN. Whenever it is not possible, the reason
        says why.
        """
        level = battery_percent(self.battery)
        if level == RobotStatus.BATTERY_UNKNOWN:
            response.reason = 'the level of the battery is unknown'
        elif not all(0.0 <= leg < math.inf for leg in request.legs):
            response.reason = 'each leg must be a distance of at least 0 m'
        else:
            used = sum(request.legs) / CheckTrip.Request.METRES_PER_PERCENT
            left = math.floor(max(0.0, level - used))
            response.battery_at_end = left
            response.possible = used <= level and left >= request.reserve
            if not response.possible:
                response.reason = f'{level} % is not enough for {used:g} % and the reserve'
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
