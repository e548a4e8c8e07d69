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

"""Two robots that report to the same place."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import PushRosNamespace, SetRemap
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    """Return both robots in one group, for which status has another name."""
    one_robot = PathJoinSubstitution(
        [FindPackageShare('my_robot_bringup'), 'launch', 'robot.launch.py'])
    arguments = [
        DeclareLaunchArgument('first', default_value='robot1', description='One robot'),
        DeclareLaunchArgument('second', default_value='robot2', description='The other robot'),
        DeclareLaunchArgument('speed', default_value='0.2', description='m/s, of both robots'),
    ]
    robots = [
        GroupAction([
            PushRosNamespace(LaunchConfiguration(which)),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(one_robot),
                launch_arguments=[
                    ('speed', LaunchConfiguration('speed')),
                    ('robot_name', LaunchConfiguration(which)),
                ]),
        ])
        for which in ('second', 'first')
    ]
    return LaunchDescription(
        [*arguments, GroupAction([SetRemap('status', '/fleet/status'), *robots])])
