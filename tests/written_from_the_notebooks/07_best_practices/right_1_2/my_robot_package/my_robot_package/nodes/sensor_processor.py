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

"""Scans in, clean scans and a mean distance out."""

import math

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data as lidar_qos
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32

from my_robot_package.utils import data_processing


class SensorProcessor(Node):
    """The node sensor_processor."""

    def __init__(self, **kwargs):
        """Hand kwargs on to Node; create two publishers and a subscription."""
        super().__init__('sensor_processor', **kwargs)
        memory = data_processing.DataProcessor(10)
        clean = self.create_publisher(LaserScan, 'scan_filtered', lidar_qos)
        mean = self.create_publisher(Float32, 'mean_distance', qos_profile=10)
        log = self.get_logger()

        def on_scan(scan):
            fields = {
                name: getattr(scan, name) for name in LaserScan.get_fields_and_field_types()}
            fields['ranges'] = memory.process(scan.ranges, scan.range_min, scan.range_max)
            clean.publish(LaserScan(**fields))
            if any(map(math.isfinite, fields['ranges'])):
                mean.publish(Float32(data=memory.average()))
            else:
                log.warning('blind', throttle_duration_sec=1.0)

        self.create_subscription(LaserScan, 'scan', on_scan, lidar_qos)


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
