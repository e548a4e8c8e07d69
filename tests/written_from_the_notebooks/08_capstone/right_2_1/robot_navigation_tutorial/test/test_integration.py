"""The whole system as a user starts it: the launch file, its parameters, and real topics."""

import os
from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from geometry_msgs.msg import Twist
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription, SetEnvironmentVariable
from launch.launch_description_sources import PythonLaunchDescriptionSource
import launch_pytest
import pytest
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from robot_navigation_interfaces.msg import Health
from sensor_msgs.msg import LaserScan


@launch_pytest.fixture
def navigation():
    """Launch the package's own launch file, in this test's domain."""
    share = Path(get_package_share_directory('robot_navigation_tutorial'))
    launch_file = str(share / 'launch' / 'navigation.launch.py')
    return LaunchDescription([
        SetEnvironmentVariable('ROS_DOMAIN_ID', str(1 + os.getpid() % 100)),
        IncludeLaunchDescription(PythonLaunchDescriptionSource(launch_file)),
        launch_pytest.actions.ReadyToTest(),
    ])


@pytest.mark.launch(fixture=navigation)
def test_the_robot_drives_while_it_sees_and_stops_when_the_lidar_dies(world):
    """Forward and healthy with scans, still and unhealthy without."""
    peer = world.add(Node('peer', context=world.context))
    commands, reports = [], []
    peer.create_subscription(Twist, 'cmd_vel', commands.append, 10)
    peer.create_subscription(Health, 'health', reports.append, 10)
    lidar = peer.create_publisher(LaserScan, 'scan', qos_profile_sensor_data)
    scan = LaserScan(range_min=0.1, range_max=10.0, angle_increment=0.01, ranges=[2.0] * 628)

    def see():
        scan.header.stamp = peer.get_clock().now().to_msg()
        lidar.publish(scan)

    def is_now(drives, level):
        return (
            commands and (commands[-1].linear.x > 0.0) == drives
            and reports and reports[-1].level == level)

    seeing = peer.create_timer(0.1, see)
    world.until(lambda: is_now(True, Health.OK))
    seeing.cancel()
    world.until(lambda: is_now(False, Health.FAILED))
