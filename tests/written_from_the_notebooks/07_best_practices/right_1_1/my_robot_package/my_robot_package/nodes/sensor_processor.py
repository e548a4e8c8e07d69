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

"""A filter between the lidar and the nodes that act on its scans."""

from copy import deepcopy
import time

from my_robot_package.utils.data_processing import DataProcessor, mean_distance
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32


class SensorProcessor(Node):
    """Takes scan; gives scan_filtered, and mean_distance when there is one."""

    def __init__(self, **kwargs):
        """Name the node sensor_processor; kwargs are handed on to Node."""
        super().__init__('sensor_processor', **kwargs)
        self._means = DataProcessor(history=10)
        self._next_warning = 0.0  # by time.monotonic()
        self._clean = self.create_publisher(LaserScan, 'scan_filtered', qos_profile_sensor_data)
        self._mean = self.create_publisher(Float32, 'mean_distance', 10)
        self._scans = self.create_subscription(
            LaserScan, 'scan', self.scan_callback, qos_profile_sensor_data)

    def scan_callback(self, msg):
        """Publish what the scan measured, and then the average distance or a warning."""
        clean = deepcopy(msg)
        clean.ranges = self._means.process(msg.ranges, msg.range_min, msg.range_max)
        self._clean.publish(clean)
        if mean_distance(clean.ranges) is not None:
            average = Float32()
            average.data = self._means.average()
            self._mean.publish(average)
            return
        now = time.monotonic()
        if now >= self._next_warning:
            self._next_warning = now + 1.0
            self.get_logger().warning(f'none of {len(msg.ranges)} beams measured a distance')


def main(args=None):
    """Run the node until SIGINT (Ctrl-C) or SIGTERM, then end with exit status 0."""
    rclpy.init(args=args)
    node = None
    try:
        node = SensorProcessor()
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
