"""A test of the launch file in a plain function."""

import os
import time
from pathlib import Path

import launch
import launch_pytest
import pytest
import rclpy
from ament_index_python.packages import get_package_share_directory
from geometry_msgs.msg import Twist
from launch.launch_description_sources import PythonLaunchDescriptionSource
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Range

DOMAIN = 91 + os.getpid() % 9


@launch_pytest.fixture
def system():
    """Launch the installed launch file."""
    path = Path(get_package_share_directory("speed_guard")) / "launch" / "guard.launch.py"
    return launch.LaunchDescription(
        [
            launch.actions.SetEnvironmentVariable("ROS_DOMAIN_ID", str(DOMAIN)),
            launch.actions.IncludeLaunchDescription(PythonLaunchDescriptionSource(str(path))),
        ]
    )


@pytest.mark.launch(fixture=system)
def test_crawls_at_0_55_m():
    """Half-way between 0.3 m and 0.8 m, the speed is halved."""
    context = Context()
    rclpy.init(context=context, domain_id=DOMAIN)
    node = rclpy.create_node("tester", context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    answers = []
    node.create_subscription(Twist, "cmd_vel", lambda msg: answers.append(msg.linear.x), 10)
    sensor = node.create_publisher(Range, "distance", qos_profile_sensor_data)
    planner = node.create_publisher(Twist, "cmd_vel_raw", 10)
    command = Twist()
    command.linear.x = 1.0

    def tick():
        sensor.publish(Range(range=0.55))
        planner.publish(command)

    node.create_timer(0.05, tick)
    is_found = False
    deadline = time.monotonic() + 10.0
    while time.monotonic() < deadline and not (is_found and pytest.approx(0.5) in answers):
        executor.spin_once(timeout_sec=0.1)
        is_found = "speed_guard" in node.get_node_names()
    node.destroy_node()
    rclpy.try_shutdown(context=context)
    assert is_found
    assert max(answers, default=0.0) == pytest.approx(0.5)
