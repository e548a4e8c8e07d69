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

"""The guard as its users start it."""

from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription, SetEnvironmentVariable
from launch.launch_description_sources import PythonLaunchDescriptionSource
import launch_pytest
from launch_pytest.actions import ReadyToTest
from launch_ros.substitutions import FindPackageShare
import pytest

TRIES = 20
LINE = {0.4: 0.16, 0.55: 0.4, 0.7: 0.64}  # what becomes of 0.8 m/s between 0.3 m and 0.8 m


@launch_pytest.fixture
def launched(domain):
    """Launch the installed file where the test can hear it."""
    return LaunchDescription([
        SetEnvironmentVariable(name='ROS_DOMAIN_ID', value=str(domain)),
        IncludeLaunchDescription(PythonLaunchDescriptionSource(
            [FindPackageShare('speed_guard'), '/launch/guard.launch.py'])),
        ReadyToTest(),
    ])


@pytest.mark.launch(fixture=launched)
def test_the_program_is_the_guard_of_this_robot(robot):
    """Its name and its topics are right; three points show where the line begins and ends."""
    robot.meet(seconds=15.0)
    robot.until(
        lambda: ('speed_guard', '/') in robot.get_node_names_and_namespaces(), seconds=15.0)
    for distance, expected in LINE.items():
        best = 0.0
        for _ in range(TRIES):
            robot.see(distance)
            best = max(best, robot.ask(0.8).linear.x)
        assert best == pytest.approx(expected, rel=1e-4)
