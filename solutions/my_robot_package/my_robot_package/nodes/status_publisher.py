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

"""Sum up what the robot's own sensors say, once a second, for whoever watches the fleet."""

import math

from my_robot_interfaces.msg import RobotStatus
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import BatteryState, JointState

# A watcher that joins late gets the last status at once, if it asks for the same durability.
STATUS_QOS = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def battery_percent(battery):
    """Return a BatteryState's charge in whole percent, or BATTERY_UNKNOWN."""
    if battery is None or not 0.0 <= battery.percentage <= 1.0:
        return RobotStatus.BATTERY_UNKNOWN  # BatteryState says nan when it does not know
    return math.floor(battery.percentage * 100.0 + 0.5)


class StatusPublisher(Node):
    """
    Publish robot_status (my_robot_interfaces/RobotStatus) at a steady rate.

    Subscribes to battery_state (sensor_msgs/BatteryState) and joint_states
    (sensor_msgs/JointState). Both parameters are read once, at the start.
    """

    def __init__(self, **kwargs):
        super().__init__('status_publisher', **kwargs)
        self.robot_name = self.declare_parameter(
            'robot_name',
            'MyRobot01',
            ParameterDescriptor(description='who is speaking', read_only=True),
        ).value
        period = self.declare_parameter(
            'status_period',
            1.0,
            ParameterDescriptor(
                description='time between two status messages, in seconds',
                floating_point_range=[FloatingPointRange(from_value=0.05, to_value=60.0)],
                read_only=True,
            ),
        ).value
        self.battery = None
        self.joints = None
        self.publisher = self.create_publisher(RobotStatus, 'robot_status', STATUS_QOS)
        self.create_subscription(BatteryState, 'battery_state', self.battery_callback, 10)
        self.create_subscription(JointState, 'joint_states', self.joint_callback, 10)
        self.create_timer(period, self.publish_status)
        self.get_logger().info(f'Status of {self.robot_name} every {period:g} s')

    def battery_callback(self, msg):
        """Keep the newest battery state."""
        self.battery = msg

    def joint_callback(self, msg):
        """Keep the newest joint positions."""
        self.joints = msg

    def publish_status(self):
        """Publish what is known now; what was never heard of stays unknown or empty."""
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
        if rclpy.ok():  # if not, a signal fell between two waits, and rclpy tripped over it
            raise
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
