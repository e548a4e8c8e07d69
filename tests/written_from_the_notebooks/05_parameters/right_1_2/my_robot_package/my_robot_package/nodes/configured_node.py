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

"""Drive up to what stands ahead, and stop in front of it, by parameters that can change."""

from geometry_msgs.msg import Twist
from rcl_interfaces.msg import SetParametersResult
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import BatteryState, LaserScan

from my_robot_package.configuration import contradiction, declare_configuration

SCAN_TIMEOUT = 0.5  # s without a scan, after which the robot counts as blind


class ConfiguredNode(Node):
    """
    Drive straight on, slow down before an obstacle and stop at the safety distance.

    Subscribes to scan (sensor_msgs/LaserScan) and battery_state (sensor_msgs/BatteryState),
    publishes cmd_vel (geometry_msgs/Twist) control_frequency times a second.
    """

    def __init__(self, **kwargs):
        """Declare the parameters, create the endpoints, and listen to changes."""
        super().__init__('configured_node', **kwargs)
        declare_configuration(self)
        self.distance = None  # m straight ahead; None while the robot is blind
        self.charge = None  # percent; None until the battery has spoken
        self.cmd_vel_pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(
            LaserScan, 'scan', self.scan_callback, qos_profile_sensor_data)
        self.create_subscription(
            BatteryState, 'battery_state', self.battery_callback, qos_profile_sensor_data)
        self.watchdog = self.create_timer(SCAN_TIMEOUT, self.go_blind)
        self.timer = self.create_timer(1.0 / self.value('control_frequency'), self.control_loop)
        self.add_on_set_parameters_callback(self.validate)
        self.add_post_set_parameters_callback(self.apply)
        self.get_logger().info(f"{self.value('robot_name')} is ready")

    def value(self, name):
        """Return a parameter's present value."""
        return self.get_parameter(name).value

    def validate(self, parameters):
        """Judge a request; change nothing."""
        safety, slow = (self.value(name) for name in ('safety_distance', 'slow_distance'))
        for parameter in parameters:
            match parameter.name:
                case 'safety_distance':
                    safety = parameter.value
                case 'slow_distance':
                    slow = parameter.value
        if problem := contradiction(safety, slow):
            return SetParametersResult(successful=False, reason=problem)
        return SetParametersResult(successful=True)

    def apply(self, parameters):
        """Act on a request that was taken: set the timer to the frequency that is set now."""
        if any(parameter.name == 'control_frequency' for parameter in parameters):
            self.timer.timer_period_ns = int(1_000_000_000 / self.value('control_frequency'))

    def scan_callback(self, scan):
        """Remember what the beam straight ahead reads; the robot can see again."""
        self.distance = scan.ranges[round(-scan.angle_min / scan.angle_increment)]
        self.watchdog.reset()

    def go_blind(self):
        """Forget the last reading: it is too old to rely on."""
        self.distance = None

    def battery_callback(self, battery):
        """Remember the charge; a driver says 0.0 to 1.0, or nan when it does not know."""
        self.charge = battery.percentage * 100.0

    def control_loop(self):
        """Publish one command: straight on, at the speed that fits."""
        command = Twist()
        command.linear.x = self.speed()
        self.cmd_vel_pub.publish(command)

    def speed(self):
        """
        Return the forward speed in m/s.

        Full speed from slow_distance on, falling evenly to nothing at safety_distance;
        nothing without a reading (nan fails each comparison) or with a battery below its
        threshold.
        """
        if self.charge is not None and self.charge < self.value('battery_threshold'):
            return 0.0
        safety, slow = self.value('safety_distance'), self.value('slow_distance')
        if self.distance is None or not self.distance > safety:
            return 0.0
        share = min(1.0, (self.distance - safety) / (slow - safety))
        return share * self.value('max_linear_velocity')


def main(args=None):
    """Run the node until SIGINT (Ctrl-C) or SIGTERM, then end with exit status 0."""
    rclpy.init(args=args)
    node = None
    try:
        node = ConfiguredNode()
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
