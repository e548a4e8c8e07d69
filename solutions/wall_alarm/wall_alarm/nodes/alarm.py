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


"""Say whether something is near, at each scan."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool
from wall_alarm.utils.nearest import nearest


class Alarm(Node):
    """
    Subscribe to scan (sensor_msgs/LaserScan), publish alarm (std_msgs/Bool).

    The alarm is true when something is nearer than the parameter distance, in metres, and
    when the lidar sees nothing that counts: a blind robot is no safe robot.
    """

    def __init__(self, **kwargs):
        super().__init__('alarm', **kwargs)
        self.distance = self.declare_parameter('distance', 0.5).value
        self.alarm_pub = self.create_publisher(Bool, 'alarm', 10)
        self.create_subscription(
            LaserScan, 'scan', self.scan_callback, qos_profile_sensor_data)
        self.get_logger().info(f'The alarm goes off at {self.distance:g} m')

    def scan_callback(self, msg):
        """Answer each scan with an alarm, true or false."""
        distance = nearest(msg)
        self.alarm_pub.publish(Bool(data=distance is None or distance < self.distance))


def main(args=None):
    """Run the node until SIGINT (Ctrl-C) or SIGTERM, then end with exit status 0."""
    rclpy.init(args=args)
    node = None
    try:
        node = Alarm()
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
