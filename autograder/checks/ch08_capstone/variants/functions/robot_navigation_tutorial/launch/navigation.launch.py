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

"""Start the three nodes by a function that runs once the arguments are known."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def start(context):
    """Return the nodes, with the values of the arguments."""
    file = LaunchConfiguration('params_file').perform(context)
    use_sim_time = LaunchConfiguration('use_sim_time').perform(context).lower() == 'true'
    common = {'package': 'robot_navigation_tutorial', 'output': 'screen'}
    parameters = [file, {'use_sim_time': use_sim_time}]
    return [
        Node(executable=name, name=name, parameters=parameters, **common)
        for name in ('status_monitor', 'navigation_controller', 'sensor_processor')
    ]


def generate_launch_description():
    """Declare two arguments, then start the nodes."""
    default = [FindPackageShare('robot_navigation_tutorial'), '/config/navigation.yaml']
    return LaunchDescription(
        [
            DeclareLaunchArgument('use_sim_time', default_value='false', description='use /clock'),
            DeclareLaunchArgument('params_file', default_value=default, description='a YAML file'),
            OpaqueFunction(function=start),
        ]
    )
