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

"""Publish each laser scan again, with nan for each reading that is not a measurement."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32

from my_robot_package.utils.data_processing import DataProcessor, mean_distance

HISTORY = 10  # the published mean covers this many scans
WARN_PERIOD = 1.0  # s between two warnings


class SensorProcessor(Node):
    """
    Cleans scans for the nodes that act on them.

    Subscribes to scan (sensor_msgs/LaserScan). Publishes scan_filtered
    (sensor_msgs/LaserScan), with nan where a reading is not a measurement, and
    mean_distance (std_msgs/Float32), how far away things were on average in the newest
    HISTORY scans.
    """

    def __init__(self, **kwargs):
        """
        Name the node sensor_processor; create its publishers and its subscription.

        scan and scan_filtered: qos_profile_sensor_data. mean_distance: a queue of 10.
        kwargs are passed on to Node.
        """
        super().__init__('sensor_processor', **kwargs)
        self.processor = DataProcessor(HISTORY)
        self.filtered_pub = self.create_publisher(
            LaserScan, 'scan_filtered', qos_profile_sensor_data)
        self.mean_pub = self.create_publisher(Float32, 'mean_distance', 10)
        self.create_subscription(
            LaserScan, 'scan', self.scan_callback, qos_profile_sensor_data)
        self.get_logger().info('Sensor processor initialised')

    def scan_callback(self, msg):
        """
        Publish the scan with masked ranges and all other fields unchanged, then the mean.

        A scan without a finite distance does not change the mean. It is published masked,
        without a mean, and a warning is logged, at most once every WARN_PERIOD.
        """
        msg.ranges = self.processor.process(msg.ranges, msg.range_min, msg.range_max)
        self.filtered_pub.publish(msg)
        if mean_distance(msg.ranges) is None:
            self.get_logger().warning(
                'No distance in this scan', throttle_duration_sec=WARN_PERIOD)
        else:
            self.mean_pub.publish(Float32(data=self.processor.average()))


def main(args=None):
    """Run the node until SIGINT (Ctrl-C) or SIGTERM."""
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
