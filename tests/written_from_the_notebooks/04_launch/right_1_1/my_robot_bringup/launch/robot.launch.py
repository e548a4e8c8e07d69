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

"""One robot."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction
from launch.conditions import IfCondition
from launch.substitutions import EqualsSubstitution, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterFile, ParameterValue
from launch_ros.substitutions import FindPackageShare

PACKAGE = 'my_robot_bringup'
ARGUMENTS = {
    'robot_name': {'default_value': 'robot1', 'description': 'The name in the reports'},
    'speed': {'default_value': '0.2', 'description': 'How fast the driver drives (m/s)'},
    'report': {
        'default_value': 'true',
        'description': 'Whether there is a reporter',
        'choices': ['true', 'false'],
    },
}


def parameters(name, kind):
    """Return the parameters of a node: the file, and one argument of a certain type."""
    path = PathJoinSubstitution([FindPackageShare(PACKAGE), 'config', 'robot.yaml'])
    value = ParameterValue(LaunchConfiguration(name), value_type=kind)
    return [ParameterFile(path), {name: value}]


def generate_launch_description():
    """Return what belongs to one robot."""
    description = LaunchDescription()
    for name, details in ARGUMENTS.items():
        description.add_action(DeclareLaunchArgument(name, **details))
    wanted = EqualsSubstitution(LaunchConfiguration('report'), 'true')
    description.add_action(GroupAction(condition=IfCondition(wanted), actions=[
        Node(package=PACKAGE, executable='reporter', name='reporter', output='screen',
             parameters=parameters('robot_name', str)),
    ]))
    description.add_action(
        Node(package=PACKAGE, executable='driver', name='driver', output='screen',
             parameters=parameters('speed', float)))
    return description
