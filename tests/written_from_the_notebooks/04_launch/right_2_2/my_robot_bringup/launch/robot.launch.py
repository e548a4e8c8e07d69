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

"""
Start one robot.

The nodes are made while the launch runs: by then, each argument is a plain text.
"""

import os

from ament_index_python.packages import get_package_share_path
import launch
import launch.actions
import launch_ros.actions
import launch_ros.parameter_descriptions


def nodes(context: launch.LaunchContext) -> list:
    """Return the nodes that the arguments ask for."""
    chosen = context.launch_configurations
    file = os.fspath(get_package_share_path('my_robot_bringup') / 'config' / 'robot.yaml')
    text = launch_ros.parameter_descriptions.ParameterValue(chosen['robot_name'], value_type=str)
    own = {'driver': {'speed': float(chosen['speed'])}, 'reporter': {'robot_name': text}}
    if chosen['report'] == 'false':
        del own['reporter']
    return [
        launch_ros.actions.Node(
            package='my_robot_bringup', executable=name, name=name,
            output='screen', parameters=[file, values])
        for name, values in own.items()
    ]


def generate_launch_description() -> launch.LaunchDescription:
    """Declare three arguments, and leave the rest to `nodes`."""
    declare = launch.actions.DeclareLaunchArgument
    return launch.LaunchDescription([
        declare('report', default_value='true', choices=['false', 'true'],
                description='true: the reporter runs; false: it does not'),
        declare('robot_name', default_value='robot1', description='the name in the reports'),
        declare('speed', default_value='0.2', description='m/s, forward'),
        launch.actions.OpaqueFunction(function=nodes),
    ])
