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

"""A node that takes the phantoms out of laser scans."""

from array import array

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32

from my_robot_package.utils import data_processing


class SensorProcessor(Node):
    """
    Subscribes to scan, publishes scan_filtered and mean_distance.

    The two scans are of type sensor_msgs/LaserScan, the mean is a std_msgs/Float32 in metres.
    """

    def __init__(self, **kwargs):
        """Name the node, and create its three endpoints; kwargs are those of Node."""
        super().__init__('sensor_processor', **kwargs)
        self._means = data_processing.DataProcessor(10)
        create, profile = self.create_publisher, qos_profile_sensor_data
        self._say_filtered = create(LaserScan, 'scan_filtered', profile).publish
        self._say_mean = create(Float32, 'mean_distance', 10).publish
        self.create_subscription(LaserScan, 'scan', self.scan_callback, profile)

    def scan_callback(self, msg):
        """Publish what becomes of a scan, and its mean or a warning."""
        ranges = self._means.process(msg.ranges, msg.range_min, msg.range_max)
        fields = {name: getattr(msg, name) for name in msg.get_fields_and_field_types()}
        self._say_filtered(LaserScan(**{**fields, 'ranges': array('f', ranges)}))
        is_blind = data_processing.mean_distance(ranges) is None
        if is_blind:
            self.get_logger().warning(
                f'None of {len(ranges)} readings is a distance', throttle_duration_sec=1.0)
        else:
            self._say_mean(Float32(data=self._means.average()))


def main(args=None):
    """Run the node in an executor of its own, until SIGINT or SIGTERM."""
    rclpy.init(args=args)
    node = executor = None
    try:
        node = SensorProcessor()
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except RuntimeError:
        if rclpy.ok():
            raise
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
