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

"""Two robots, one of them in each of two namespaces; both report to the fleet."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import PushRosNamespace, SetRemap
from launch_ros.substitutions import FindPackageShare

ROBOTS = {'first': 'robot1', 'second': 'robot2'}
ONE_ROBOT = PathJoinSubstitution(
    [FindPackageShare('my_robot_bringup'), 'launch', 'robot.launch.py'])


def generate_launch_description():
    """Return arguments first; then one remapping for all; then a group for each robot."""
    entities = [
        DeclareLaunchArgument(
            argument, default_value=default,
            description=f'Namespace of the {argument} robot, which is its name, too.')
        for argument, default in ROBOTS.items()
    ]
    entities.append(DeclareLaunchArgument(
        'speed', default_value='0.2', description='Speed of the two robots, in m/s.'))
    entities.append(SetRemap(src='status', dst='/fleet/status'))
    for argument in ROBOTS:
        entities.append(GroupAction(actions=[
            PushRosNamespace(namespace=LaunchConfiguration(argument)),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(ONE_ROBOT),
                launch_arguments=[
                    ('robot_name', LaunchConfiguration(argument)),
                    ('speed', LaunchConfiguration('speed')),
                ]),
        ]))
    return LaunchDescription(entities)
