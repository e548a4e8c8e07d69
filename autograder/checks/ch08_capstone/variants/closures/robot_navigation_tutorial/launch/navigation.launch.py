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

"""Start the three nodes in a group, whose scope sets their parameters."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node, SetParameter, SetParametersFromFile
from launch_ros.substitutions import FindPackageShare

PACKAGE = 'robot_navigation_tutorial'


def generate_launch_description():
    """Return two arguments and the group of nodes."""
    file = PathJoinSubstitution([FindPackageShare(PACKAGE), 'config', 'navigation.yaml'])

    def node(name):
        return Node(package=PACKAGE, executable=name, name=name, output='screen')

    return LaunchDescription([
        DeclareLaunchArgument('params_file', default_value=file, description='which file'),
        DeclareLaunchArgument('use_sim_time', default_value='false', description='which clock'),
        GroupAction([
            SetParametersFromFile(LaunchConfiguration('params_file')),
            SetParameter('use_sim_time', LaunchConfiguration('use_sim_time')),
            *map(node, ('sensor_processor', 'navigation_controller', 'status_monitor')),
        ]),
    ])
