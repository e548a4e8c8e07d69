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

"""Start the motor guard."""

import launch
from launch.substitutions import LaunchConfiguration
import launch_ros.actions
from launch_ros.parameter_descriptions import ParameterValue

PACKAGE = 'motor_guard'


def generate_launch_description():
    """Return the description: one argument, three nodes."""
    description = launch.LaunchDescription()
    description.add_action(launch.actions.DeclareLaunchArgument(
        'hot', default_value='60.0', description='switch the fan on from here (degrees Celsius)'))
    hot = LaunchConfiguration('hot')
    for name in ('guard', 'smoother', 'thermometer'):  # who listens comes first
        extra = {'parameters': [{'hot': ParameterValue(hot, value_type=float)}]}
        description.add_action(launch_ros.actions.Node(
            package=PACKAGE,
            executable=name,
            name=name,
            output={'both': 'screen'},
            **(extra if name == 'guard' else {}),
        ))
    return description
