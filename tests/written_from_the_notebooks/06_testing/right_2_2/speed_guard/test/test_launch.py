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

"""From the launch file to the motors: the guard that users get."""

from launch import LaunchDescription
import launch.actions as actions
from launch.launch_description_sources import AnyLaunchDescriptionSource
from launch.substitutions import PathJoinSubstitution
import launch_pytest
import launch_pytest.actions
from launch_ros.substitutions import FindPackageShare
from pytest import approx, mark


@launch_pytest.fixture
def guard_program(domain):
    """Include the installed file, in the domain of this test."""
    description = LaunchDescription()
    description.add_action(actions.SetEnvironmentVariable('ROS_DOMAIN_ID', f'{domain}'))
    description.add_action(actions.IncludeLaunchDescription(
        AnyLaunchDescriptionSource(PathJoinSubstitution(
            [FindPackageShare('speed_guard'), 'launch', 'guard.launch.py']))))
    description.add_action(launch_pytest.actions.ReadyToTest())
    return description


@mark.launch(fixture=guard_program)
def test_the_launched_guard(robot):
    """Three points of its line say where it begins and where it ends."""
    robot.meet(seconds=10.0)
    robot.until(
        lambda: ('speed_guard', '/') in robot.get_node_names_and_namespaces(), seconds=10.0)
    for distance, speed in ((0.425, 0.25), (0.55, 0.5), (0.675, 0.75)):
        answers = []
        for _ in range(20):
            robot.see(distance)
            answers.append(robot.ask(1.0).linear.x)
        assert max(answers) == approx(speed, abs=1e-4)
