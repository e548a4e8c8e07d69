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

"""Bring two robots up, each by robot.launch.py."""

import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import (
    DeclareLaunchArgument,
    GroupAction,
    IncludeLaunchDescription,
    OpaqueFunction,
)
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch_ros.actions import PushRosNamespace, SetRemap

DEFAULTS = {
    'first': ('robot1', 'the first robot: its namespace and its name'),
    'second': ('robot2', 'the second robot: its namespace and its name'),
    'speed': ('0.2', 'speed of both robots in m/s'),
}


def start(context):
    """Return a group for each robot."""
    path = os.path.join(
        get_package_share_directory('my_robot_bringup'), 'launch', 'robot.launch.py')
    speed = context.launch_configurations['speed']
    groups = []
    for which in ('first', 'second'):
        name = context.launch_configurations[which]
        include = IncludeLaunchDescription(
            PythonLaunchDescriptionSource(path),
            launch_arguments={'robot_name': name, 'speed': speed}.items())
        groups.append(GroupAction(
            actions=[SetRemap(src='status', dst='/fleet/status'), PushRosNamespace(name), include],
            scoped=True))
    return groups


def generate_launch_description():
    """Declare the arguments; the rest waits for their values."""
    description = LaunchDescription([
        DeclareLaunchArgument(name, default_value=default, description=text)
        for name, (default, text) in DEFAULTS.items()
    ])
    description.add_action(OpaqueFunction(function=start))
    return description
