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

"""Start sensor_processor, navigation_controller and status_monitor."""

import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node, SetParameter


def generate_launch_description():
    """Return a group in which all nodes have the same clock."""
    package = 'robot_navigation_tutorial'
    config = os.path.join(get_package_share_directory(package), 'config', 'navigation.yaml')
    details = {
        'package': package,
        'output': 'screen',
        'parameters': [LaunchConfiguration('params_file')],
    }
    return LaunchDescription([
        DeclareLaunchArgument('params_file', default_value=config, description='parameters'),
        DeclareLaunchArgument('use_sim_time', default_value='false', description='which clock'),
        GroupAction([
            SetParameter(name='use_sim_time', value=LaunchConfiguration('use_sim_time')),
            Node(executable='sensor_processor', name='sensor_processor', **details),
            Node(executable='navigation_controller', name='navigation_controller', **details),
            Node(executable='status_monitor', name='status_monitor', **details),
        ]),
    ])
