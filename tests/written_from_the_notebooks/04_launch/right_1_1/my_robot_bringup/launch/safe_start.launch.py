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

"""A start in which each node says what happens when it ends."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, Shutdown
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def node(name, **details):
    """Return a node that has the name of its executable."""
    return Node(
        package='my_robot_bringup', executable=name, name=name, output='screen', **details)


def generate_launch_description():
    """Return the self-test and the reporter; the driver comes later."""
    driver = node('driver', on_exit=[Shutdown(reason='no driver')])
    level = ParameterValue(LaunchConfiguration('battery'), value_type=float)

    def next_step(event, context):
        """Go on, or give up."""
        failed = event.returncode != 0
        return [Shutdown(reason='self-test')] if failed else [driver]

    return LaunchDescription([
        DeclareLaunchArgument('battery', default_value='80', description='Charge in percent'),
        node('reporter', respawn=True, respawn_delay=0.5),
        node('self_test', parameters=[{'battery': level}], on_exit=next_step),
    ])
