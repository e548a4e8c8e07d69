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

"""Start the driver after the self-test has passed, and shut down when the driver ends."""

from launch import LaunchDescription
from launch.actions import (
    DeclareLaunchArgument,
    LogInfo,
    RegisterEventHandler,
    Shutdown,
)
from launch.event_handlers import OnProcessExit
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    """
    Declare battery (80); start self_test and reporter immediately, driver after the self-test.

    battery: the self-test's parameter battery, always a float, in percent.
    self_test ends with 0: the driver starts. With anything else: everything shuts down.
    driver ends in any way: everything shuts down.
    reporter ends: it is started again half a second later.
    """
    battery = ParameterValue(LaunchConfiguration('battery'), value_type=float)
    self_test = Node(
        package='my_robot_bringup', executable='self_test', name='self_test',
        parameters=[{'battery': battery}], output='screen')
    reporter = Node(
        package='my_robot_bringup', executable='reporter', name='reporter',
        respawn=True, respawn_delay=0.5, output='screen')
    driver = Node(
        package='my_robot_bringup', executable='driver', name='driver', output='screen')

    def after_self_test(event, context):
        """Return the actions that follow the self-test."""
        if event.returncode == 0:
            return [driver]
        return [Shutdown(reason='the self-test failed')]

    return LaunchDescription([
        DeclareLaunchArgument(
            'battery', default_value='80', description='charge of the battery, in percent'),
        RegisterEventHandler(OnProcessExit(target_action=self_test, on_exit=after_self_test)),
        RegisterEventHandler(OnProcessExit(target_action=driver, on_exit=[
            LogInfo(msg='The driver has ended, and the robot with it'),
            Shutdown(reason='the driver has ended'),
        ])),
        self_test,
        reporter,
    ])
