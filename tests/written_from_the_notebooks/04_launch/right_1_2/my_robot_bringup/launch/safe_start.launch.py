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

"""Test, then drive; one handler looks at every process that ends."""

from launch import LaunchDescription
from launch.actions import (
    DeclareLaunchArgument,
    EmitEvent,
    OpaqueFunction,
    RegisterEventHandler,
)
from launch.event_handlers import OnProcessExit
from launch.events import Shutdown
from launch_ros.actions import Node

PACKAGE = 'my_robot_bringup'


def start(context):
    """Return the handler, and the nodes that start immediately."""
    battery = float(context.launch_configurations['battery'])
    test = Node(package=PACKAGE, executable='self_test', name='self_test', output='screen',
                parameters=[{'battery': battery}])
    driver = Node(package=PACKAGE, executable='driver', name='driver', output='screen')
    reporter = Node(package=PACKAGE, executable='reporter', name='reporter', output='screen',
                    respawn=True, respawn_delay=0.6)

    def ended(event, context):
        """Say what follows: a driver after a good test, the end after the others."""
        if event.action is reporter:
            return None  # it comes back by itself
        if event.action is test and event.returncode == 0:
            return [driver]
        return [EmitEvent(event=Shutdown(reason=f'{event.process_name} has ended'))]

    return [RegisterEventHandler(OnProcessExit(on_exit=ended)), test, reporter]


def generate_launch_description():
    """Declare battery; start."""
    return LaunchDescription([
        DeclareLaunchArgument('battery', default_value='80', description='percent'),
        OpaqueFunction(function=start),
    ])
