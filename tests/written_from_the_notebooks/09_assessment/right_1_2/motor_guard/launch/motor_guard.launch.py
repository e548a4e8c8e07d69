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

"""Start all nodes of this package."""

import launch
from launch.actions import DeclareLaunchArgument as Argument
from launch.substitutions import LaunchConfiguration as Configuration
import launch_ros.actions
import launch_ros.parameter_descriptions


def node(name, *parameters):
    """Return a node whose executable has the same name."""
    return launch_ros.actions.Node(
        package='motor_guard', executable=name, name=name, parameters=list(parameters),
        output='both', emulate_tty=True)


def generate_launch_description():
    """Return the argument hot, and the nodes."""
    hot = launch_ros.parameter_descriptions.ParameterValue(Configuration('hot'), value_type=float)
    return launch.LaunchDescription([
        Argument('hot', default_value=['60.0'], description='degrees Celsius: the fan starts'),
        node('guard', {'hot': hot}), node('smoother'), node('thermometer')])
