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

"""One robot: the driver always, the reporter on request."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction
from launch.conditions import UnlessCondition
from launch.substitutions import EqualsSubstitution, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node, SetParametersFromFile
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

PACKAGE = 'my_robot_bringup'


def argument(name, default, text, **more):
    """Return the declaration of one argument."""
    return DeclareLaunchArgument(name, default_value=default, description=text, **more)


def program(name, own, kind, **more):
    """Return a node whose parameter `own` is the argument of that name, read as `kind`."""
    value = ParameterValue(LaunchConfiguration(own), value_type=kind)
    return Node(
        package=PACKAGE, executable=name, name=name, output='screen', parameters=[{own: value}],
        **more)


def generate_launch_description():
    """Say what can be chosen, and start what was chosen."""
    description = LaunchDescription()
    for declaration in (
        argument('robot_name', 'robot1', 'The name under which the robot reports.'),
        argument('speed', '0.2', 'How fast the robot drives, in m/s.'),
        argument('report', 'true', 'Should the robot report?', choices=['true', 'false']),
    ):
        description.add_action(declaration)
    quiet = EqualsSubstitution(LaunchConfiguration('report'), 'false')
    description.add_action(GroupAction([
        # It comes before what the two nodes set themselves, so those values win.
        SetParametersFromFile(PathJoinSubstitution(
            [FindPackageShare(PACKAGE), 'config', 'robot.yaml'])),
        program('driver', 'speed', float),
        program('reporter', 'robot_name', str, condition=UnlessCondition(quiet)),
    ]))
    return description
