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

"""Start safely: test, then drive, then end. One handler looks after all that ends."""

from launch import LaunchDescription, Substitution
from launch.actions import DeclareLaunchArgument, EmitEvent, RegisterEventHandler
from launch.event_handlers import OnProcessExit
from launch.events import Shutdown
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

HALF_A_SECOND = 0.5
BATTERY: Substitution = LaunchConfiguration('battery')


def generate_launch_description() -> LaunchDescription:
    """Return an argument, two nodes that start, and a handler that knows the third one."""
    here = {'package': 'my_robot_bringup', 'output': 'screen'}
    test = Node(
        executable='self_test', name='self_test',
        parameters=[{'battery': ParameterValue(BATTERY, value_type=float)}], **here)
    drive = Node(executable='driver', name='driver', **here)
    report = Node(
        executable='reporter', name='reporter',
        respawn=True, respawn_delay=HALF_A_SECOND, **here)

    def what_now(event, context):
        """Go on after a good test; end after a bad one, and after the driver."""
        if event.action is test and not event.returncode:
            return [drive]
        if event.action is test or event.action is drive:
            return [EmitEvent(event=Shutdown(reason='nothing is left to do'))]
        return []

    return LaunchDescription([
        DeclareLaunchArgument('battery', default_value='80', description='charge in percent'),
        report,
        test,
        RegisterEventHandler(OnProcessExit(on_exit=what_now)),
    ])
