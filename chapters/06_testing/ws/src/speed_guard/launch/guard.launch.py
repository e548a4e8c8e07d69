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

"""Start the guard with the distances that suit this robot."""

from launch import LaunchDescription
from launch.substitutions import PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    """Run the node speed_guard by config/guard.yaml."""
    config = PathJoinSubstitution([FindPackageShare('speed_guard'), 'config', 'guard.yaml'])
    return LaunchDescription([
        Node(
            package='speed_guard',
            executable='speed_guard',
            name='speed_guard',
            parameters=[config],
            output='screen',
        ),
    ])
