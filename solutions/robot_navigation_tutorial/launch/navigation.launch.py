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

"""Start the three nodes of the navigation together."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

PACKAGE = 'robot_navigation_tutorial'
NODES = ('sensor_processor', 'navigation_controller', 'status_monitor')


def generate_launch_description():
    """Return the two arguments, and the three nodes that use their values."""
    config = Path(get_package_share_directory(PACKAGE)) / 'config' / 'navigation.yaml'
    params_file = LaunchConfiguration('params_file')
    use_sim_time = LaunchConfiguration('use_sim_time')
    return LaunchDescription([
        DeclareLaunchArgument(
            'params_file', default_value=str(config), description='Parameters of the nodes'),
        DeclareLaunchArgument(
            'use_sim_time', default_value='false', description='Take the time from /clock'),
        *(
            Node(
                package=PACKAGE,
                executable=name,
                name=name,
                parameters=[params_file, {'use_sim_time': use_sim_time}],
                output='screen',
            )
            for name in NODES
        ),
    ])
