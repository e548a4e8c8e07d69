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

"""A robot that drives only with enough charge; it ends when its driver ends."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, Shutdown
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def node(executable, **more):
    """Return a node of this package, named after its executable."""
    return Node(
        package='my_robot_bringup', executable=executable, name=executable, output='screen',
        **more)


def generate_launch_description():
    """Start the self-test and the reporter; the self-test's end decides about the driver."""
    driver = node('driver', on_exit=[Shutdown(reason='without its driver, no robot')])

    def decide(event, _):
        """Return the driver after a success, else the end of it all."""
        passed = event.returncode == 0
        return [driver if passed else Shutdown(reason='the robot may not drive')]

    charge = ParameterValue(LaunchConfiguration('battery'), value_type=float)
    return LaunchDescription([
        DeclareLaunchArgument(
            name='battery',
            default_value='80',
            description='What the self-test finds in the battery, in percent.',
        ),
        node('reporter', respawn=True, respawn_delay=0.5),
        node('self_test', parameters=[{'battery': charge}], on_exit=decide),
    ])
