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

"""The guard as its users start it: by the launch file that is installed."""

from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription, SetEnvironmentVariable
import launch_pytest
from launch_pytest.actions import ReadyToTest
from launch_ros.substitutions import FindPackageShare
import pytest

EXPECTED = {0.25: 0.0, 0.35: 0.08, 0.4: 0.16, 0.7: 0.64, 0.9: 0.8}  # m: m/s of 0.8 m/s


@launch_pytest.fixture
def launched(domain):
    """Launch guard.launch.py in the domain of the test."""
    description = LaunchDescription()
    description.add_action(SetEnvironmentVariable('ROS_DOMAIN_ID', str(domain)))
    description.add_action(IncludeLaunchDescription(
        [FindPackageShare('speed_guard'), '/launch/guard.launch.py']))
    description.add_action(ReadyToTest())
    return description


@pytest.mark.launch(fixture=launched)
def test_promise(robot):
    """It is there under its name, and brakes between 0.8 m and 0.3 m."""
    robot.meet(seconds=10.0)
    robot.until(lambda: 'speed_guard' in robot.get_node_names())
    found = {}
    for distance in sorted(EXPECTED):  # a distance that comes late makes an answer too small
        found[distance] = 0.0
        for _ in range(20):
            robot.see(distance)
            found[distance] = max(found[distance], robot.ask(0.8).linear.x)
    assert found == pytest.approx(EXPECTED)
