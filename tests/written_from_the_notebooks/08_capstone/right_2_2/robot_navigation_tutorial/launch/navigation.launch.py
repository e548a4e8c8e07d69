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

"""Bring the navigation up."""

import os.path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node, SetParameter

PACKAGE = 'robot_navigation_tutorial'


def navigation_node(program):
    """Return the action that starts a program under its own name."""
    return Node(
        package=PACKAGE, executable=program, name=program, output='screen',
        parameters=[LaunchConfiguration('params_file')])


def generate_launch_description():
    """Return the arguments, and a group of nodes that share a clock."""
    installed = os.path.join(
        get_package_share_directory(PACKAGE), 'config', 'navigation.yaml')
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, default, description in (
            ('params_file', installed, 'YAML file with parameters by node'),
            ('use_sim_time', 'false', 'true in a simulation: the clock is the topic /clock'),
        )
    ]
    nodes = GroupAction([
        SetParameter(name='use_sim_time', value=LaunchConfiguration('use_sim_time')),
        navigation_node('sensor_processor'),
        navigation_node('navigation_controller'),
        navigation_node('status_monitor'),
    ])
    return LaunchDescription([*arguments, nodes])
