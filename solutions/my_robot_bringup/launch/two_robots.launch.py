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

"""Bring up two robots, each in a namespace of its own, with one status topic for both."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import PushRosNamespace, SetRemap


def robot(name, speed):
    """
    Return a group: robot.launch.py in the namespace `name`, its status on /fleet/status.

    name and speed are substitutions or text; name is the robot's robot_name, too.
    """
    share = Path(get_package_share_directory('my_robot_bringup'))
    source = PythonLaunchDescriptionSource(str(share / 'launch' / 'robot.launch.py'))
    arguments = {'robot_name': name, 'speed': speed}
    return GroupAction([
        PushRosNamespace(name),
        SetRemap('status', '/fleet/status'),
        IncludeLaunchDescription(source, launch_arguments=arguments.items()),
    ])


def generate_launch_description():
    """Declare first (robot1), second (robot2) and speed (0.2); start both robots."""
    speed = LaunchConfiguration('speed')
    return LaunchDescription([
        DeclareLaunchArgument(
            'first', default_value='robot1', description='name and namespace of one robot'),
        DeclareLaunchArgument(
            'second', default_value='robot2', description='name and namespace of the other'),
        DeclareLaunchArgument(
            'speed', default_value='0.2', description='forward speed of both, in m/s'),
        robot(LaunchConfiguration('first'), speed),
        robot(LaunchConfiguration('second'), speed),
    ])
