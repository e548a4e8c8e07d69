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

"""The navigation: three nodes."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterFile, ParameterValue
from launch_ros.substitutions import FindPackageShare


def node(name):
    """Return a node of this package."""
    simulated = ParameterValue(LaunchConfiguration('use_sim_time'), value_type=bool)
    return Node(
        package='robot_navigation_tutorial',
        executable=name,
        name=name,
        parameters=[
            ParameterFile(LaunchConfiguration('params_file')),
            {'use_sim_time': simulated},
        ],
        output='screen',
    )


def generate_launch_description():
    """Return two arguments and three nodes."""
    usual = PathJoinSubstitution(
        [FindPackageShare('robot_navigation_tutorial'), 'config', 'navigation.yaml'])
    description = LaunchDescription()
    description.add_action(DeclareLaunchArgument(
        'use_sim_time', default_value='false', description='true in a simulation'))
    description.add_action(DeclareLaunchArgument(
        'params_file', default_value=usual, description='A file with the parameters'))
    description.add_action(node('status_monitor'))
    description.add_action(node('navigation_controller'))
    description.add_action(node('sensor_processor'))
    return description
