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

"""Start robot.launch.py twice."""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument as Argument
from launch.actions import GroupAction, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration as Value
from launch_ros.actions import PushRosNamespace, SetRemap


class Robot(GroupAction):
    """What belongs to one robot; the argument `who` holds its name."""

    def __init__(self, who: str) -> None:
        """Put the neighbour of this file into the namespace, with its status outside."""
        path = Path(__file__).with_name('robot.launch.py')
        handed_on = {'speed': Value('speed'), 'robot_name': Value(who)}
        super().__init__([
            SetRemap('status', '/fleet/status'),
            PushRosNamespace(Value(who)),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(str(path)), launch_arguments=handed_on.items()),
        ])


def generate_launch_description() -> LaunchDescription:
    """Return both robots, and what can be chosen about them."""
    return LaunchDescription([
        Argument('speed', default_value='0.2', description='speed of each robot in m/s'),
        Argument('first', default_value='robot1', description='one robot: namespace and name'),
        Argument('second', default_value='robot2', description='other robot: namespace and name'),
        Robot('first'),
        Robot('second'),
    ])
