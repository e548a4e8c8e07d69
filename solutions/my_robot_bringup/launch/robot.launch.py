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

"""Bring up one robot: its driver and, if the argument report is true, its reporter."""

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
