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

"""What becomes of a scan on its way through the node."""

from math import inf, isnan, nan

from my_robot_package.nodes.sensor_processor import SensorProcessor
import pytest
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32


def test_a_scan_comes_out_masked_and_as_long_as_it_went_in(world):
    """The header and the geometry stay, phantoms become nan, the mean is over the rest."""
    processor = world.add(SensorProcessor(context=world.context))
    peer = world.add(Node('peer', context=world.context))
    scans, means = [], []
    lidar = peer.create_publisher(LaserScan, 'scan', qos_profile_sensor_data)
    peer.create_subscription(
        LaserScan, 'scan_filtered', scans.append, qos_profile_sensor_data)
    peer.create_subscription(Float32, 'mean_distance', means.append, 10)
    world.until(lambda: (
        lidar.get_subscription_count() == 1
        and processor.count_subscribers('scan_filtered') == 1
        and processor.count_subscribers('mean_distance') == 1
        and peer.count_publishers('scan_filtered') == 1
        and peer.count_publishers('mean_distance') == 1
    ))
    sent = LaserScan(range_min=0.12, range_max=3.5, angle_increment=0.1)
    sent.header.frame_id = 'laser'
    sent.ranges = [1.0, 0.0, inf, nan, 2.0]

    def arrived():
        if not (scans and means):
            lidar.publish(sent)  # best effort: a scan may be lost, the next one comes
        return scans and means

    world.until(arrived)
    assert scans[0].header.frame_id == 'laser'
    assert scans[0].angle_increment == pytest.approx(sent.angle_increment)  # a float32 came back
    assert [isnan(reading) for reading in scans[0].ranges] == [False, True, False, True, False]
    assert scans[0].ranges[2] == inf
    assert means[0].data == pytest.approx(1.5)
