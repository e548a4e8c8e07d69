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

"""Start the three nodes by a function that runs once the arguments are known."""

import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

SHARE = get_package_share_directory('robot_navigation_tutorial')


def start(context):
    """Return the nodes, with the values of the arguments."""
    file = LaunchConfiguration('params_file').perform(context)
    simulated = LaunchConfiguration('use_sim_time').perform(context).lower() == 'true'
    return [
        Node(
            package='robot_navigation_tutorial', executable=name, name=name, output='screen',
            parameters=[file, {'use_sim_time': simulated}])
        for name in ('status_monitor', 'navigation_controller', 'sensor_processor')
    ]


def generate_launch_description():
    """Return the arguments and the nodes."""
    return LaunchDescription([
        DeclareLaunchArgument(
            'params_file', default_value=os.path.join(SHARE, 'config', 'navigation.yaml'),
            description='a file with parameters'),
        DeclareLaunchArgument(
            'use_sim_time', default_value='false', description='whether /clock is the time'),
        OpaqueFunction(function=start),
    ])
