"""The two versions of robot.launch.py that the checks write for two_robots.launch.py to include."""

from __future__ import annotations

LIKE_THE_REFERENCE = '''
"""The robot.launch.py that the checks of two_robots.launch.py write."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    """
    Declare robot_name, speed and report; start driver and reporter with config/robot.yaml.

    robot_name: the reporter's parameter robot_name, always a string; default robot1.
    speed: the driver's parameter speed, always a float, in m/s; default 0.2.
    report: whether the reporter starts, true or false; default true.
    """
    share = Path(get_package_share_directory('my_robot_bringup'))
    config = str(share / 'config' / 'robot.yaml')
    speed = ParameterValue(LaunchConfiguration('speed'), value_type=float)
    robot_name = ParameterValue(LaunchConfiguration('robot_name'), value_type=str)
    return LaunchDescription([
        DeclareLaunchArgument(
            'robot_name', default_value='robot1', description='who reports'),
        DeclareLaunchArgument(
            'speed', default_value='0.2', description='forward speed, in m/s'),
        DeclareLaunchArgument(
            'report', default_value='true', choices=['true', 'false'],
            description='whether the robot reports'),
        Node(
            package='my_robot_bringup',
            executable='driver',
            name='driver',
            parameters=[config, {'speed': speed}],
            output='screen',
        ),
        Node(
            package='my_robot_bringup',
            executable='reporter',
            name='reporter',
            parameters=[config, {'robot_name': robot_name}],
            output='screen',
            condition=IfCondition(LaunchConfiguration('report')),
        ),
    ])
'''

WITH_ONE_NODE = '''
"""A robot.launch.py with one node of another name: only a launch that includes this file starts it."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import UnlessCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    """Start the driver as wheels if report has the default of this file."""
    return LaunchDescription([
        DeclareLaunchArgument('report', default_value='false'),
        Node(
            package='my_robot_bringup', executable='driver', name='wheels',
            condition=UnlessCondition(LaunchConfiguration('report'))),
    ])
'''
