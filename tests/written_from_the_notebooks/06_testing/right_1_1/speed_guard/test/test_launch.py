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

"""What the launch file promises: the guard as a program of its own, with its configuration."""

from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription, SetEnvironmentVariable
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import PathJoinSubstitution
import launch_pytest
from launch_pytest.actions import ReadyToTest
from launch_ros.substitutions import FindPackageShare
import pytest


@launch_pytest.fixture
def launched(domain):
    """Launch guard.launch.py in the domain of the test."""
    file = PathJoinSubstitution([FindPackageShare('speed_guard'), 'launch', 'guard.launch.py'])
    return LaunchDescription([
        SetEnvironmentVariable('ROS_DOMAIN_ID', str(domain)),
        IncludeLaunchDescription(PythonLaunchDescriptionSource(file)),
        ReadyToTest(),
    ])


@pytest.mark.launch(fixture=launched)
def test_the_launched_guard_has_its_name_and_configuration(robot):
    """It brakes from 0.8 m to 0.3 m; with the defaults it would stand at 0.4 m."""
    robot.meet(seconds=10.0)  # a program needs time to start
    robot.until(lambda: ('speed_guard', '/') in robot.get_node_names_and_namespaces())
    for distance, speed in ((0.4, 0.16), (0.7, 0.64)):
        fastest = 0.0
        for _ in range(20):  # some of the answers may come too late for their distance
            robot.see(distance)
            fastest = max(fastest, robot.ask(0.8).linear.x)
        assert fastest == pytest.approx(speed)
