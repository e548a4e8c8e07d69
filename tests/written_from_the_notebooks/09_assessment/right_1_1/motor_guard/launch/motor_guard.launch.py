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

"""Bring up thermometer, smoother and guard."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def nodes(context):
    """Return the three nodes, now that hot is known."""
    hot = float(LaunchConfiguration('hot').perform(context))
    return [
        Node(package='motor_guard', executable='guard', name='guard', parameters=[{'hot': hot}]),
        Node(package='motor_guard', executable='smoother', name='smoother'),
        Node(package='motor_guard', executable='thermometer', name='thermometer'),
    ]


def generate_launch_description():
    """Return a description with one argument."""
    description = LaunchDescription()
    description.add_action(DeclareLaunchArgument(name='hot', default_value='60.0'))
    description.add_action(OpaqueFunction(function=nodes))
    return description
