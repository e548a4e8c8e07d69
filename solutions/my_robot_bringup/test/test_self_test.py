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

"""The self-test's exit status, which a launch file acts upon."""

from my_robot_bringup.self_test import main
import pytest


@pytest.mark.parametrize(('battery', 'status'), [('100.0', 0), ('20.0', 0), ('19.9', 1)])
def test_the_exit_status_says_whether_the_battery_is_charged_enough(battery, status):
    """20 percent are enough, anything less is not."""
    assert main(['--ros-args', '-p', f'battery:={battery}']) == status
