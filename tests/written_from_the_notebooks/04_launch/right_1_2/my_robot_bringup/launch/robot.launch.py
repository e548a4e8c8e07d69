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

"""Bring a robot up: what is to be started is decided when the arguments are known."""

import os

from ament_index_python.packages import get_package_share_directory
import launch
import launch.actions
import launch_ros.actions
from launch_ros.parameter_descriptions import ParameterValue


def start(context):
    """Return the nodes that the arguments ask for."""
    arguments = context.launch_configurations
    config = os.path.join(
        get_package_share_directory('my_robot_bringup'), 'config', 'robot.yaml')
    own = {'driver': {'speed': float(arguments['speed'])}}
    if arguments['report'] == 'true':
        own['reporter'] = {'robot_name': ParameterValue(arguments['robot_name'], value_type=str)}
    return [
        launch_ros.actions.Node(
            package='my_robot_bringup', executable=name, name=name, output='screen',
            parameters=[config, parameters])
        for name, parameters in own.items()
    ]


def generate_launch_description():
    """Declare three arguments, and start what they ask for."""
    declare = launch.actions.DeclareLaunchArgument
    return launch.LaunchDescription([
        declare('report', choices=['true', 'false'], default_value='true',
                description='true: with a reporter, false: without'),
        declare('speed', default_value='0.2', description='forward, in metres per second'),
        declare('robot_name', default_value='robot1', description='what the reporter calls it'),
        launch.actions.OpaqueFunction(function=start),
    ])
