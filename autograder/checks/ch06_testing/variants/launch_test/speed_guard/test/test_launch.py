"""A test of the launched guard in the style of launch_testing."""

import os
import time
import unittest

from geometry_msgs.msg import Twist
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription, SetEnvironmentVariable
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare
import launch_testing
import launch_testing.actions
import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Range

DOMAIN = 1 + os.getpid() % 100


@pytest.mark.launch_test
def generate_test_description():
    """Launch the installed launch file."""
    file = PathJoinSubstitution([FindPackageShare('speed_guard'), 'launch', 'guard.launch.py'])
    return LaunchDescription([
        SetEnvironmentVariable('ROS_DOMAIN_ID', str(DOMAIN)),
        IncludeLaunchDescription(PythonLaunchDescriptionSource(file)),
        launch_testing.actions.ReadyToTest(),
    ])


class TestGuard(unittest.TestCase):
    """Test cases that run while the guard runs."""

    def setUp(self):
        """Create a node in the domain of the guard."""
        self.context = Context()
        rclpy.init(context=self.context, domain_id=DOMAIN)
        self.node = rclpy.create_node('asker', context=self.context)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)

    def tearDown(self):
        """Destroy the node."""
        self.executor.shutdown()
        self.node.destroy_node()
        rclpy.try_shutdown(context=self.context)

    def test_half_way_is_half_as_fast(self):
        """Half-way between 0.3 m and 0.8 m, the speed is halved."""
        answers = []
        self.node.create_subscription(
            Twist, '/cmd_vel', lambda answer: answers.append(answer.linear.x), 10)
        sensor = self.node.create_publisher(Range, '/distance', qos_profile_sensor_data)
        planner = self.node.create_publisher(Twist, '/cmd_vel_raw', 10)
        command = Twist()
        command.linear.x = 1.0

        def tick():
            sensor.publish(Range(range=0.55))
            planner.publish(command)

        timer = self.node.create_timer(0.05, tick)
        names = []
        deadline = time.monotonic() + 10.0
        while time.monotonic() < deadline and not (
                'speed_guard' in names and any(abs(answer - 0.5) < 1e-4 for answer in answers)):
            self.executor.spin_once(timeout_sec=0.1)
            names = self.node.get_node_names()
        timer.cancel()
        self.assertAlmostEqual(max(answers, default=0.0), 0.5, places=4)
        self.assertIn('speed_guard', names)
