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

"""Start the three nodes of the motor guard together."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    """
    Declare hot (60.0); start thermometer, smoother and guard under these names.

    hot: the guard's parameter hot, in degrees Celsius, always a float.
    """
    hot = ParameterValue(LaunchConfiguration('hot'), value_type=float)
    parameters = {'guard': [{'hot': hot}]}
    return LaunchDescription([
        DeclareLaunchArgument(
            'hot', default_value='60.0', description='from which temperature on the fan runs'),
        *(
            Node(
                package='motor_guard',
                executable=name,
                name=name,
                parameters=parameters.get(name, []),
                output='screen',
            )
            for name in ('thermometer', 'smoother', 'guard')
        ),
    ])
