"""Start one robot; actions are added to the launch description one by one."""

import os

from ament_index_python.packages import get_package_share_directory
import launch
import launch.actions
import launch.conditions
import launch.substitutions as subs
import launch_ros.actions
from launch_ros.parameter_descriptions import ParameterFile, ParameterValue

PACKAGE = 'my_robot_bringup'
ARGUMENTS = (
    ('speed', '0.2', None, 'How fast the robot drives (m/s)'),
    ('robot_name', 'robot1', None, 'The name under which it reports'),
    ('report', 'true', ('true', 'false'), 'Whether it reports at all'),
)


def generate_launch_description():
    """Return the launch description of one robot."""
    description = launch.LaunchDescription()
    for name, default, choices, text in ARGUMENTS:
        description.add_action(launch.actions.DeclareLaunchArgument(
            name, default_value=default, choices=choices, description=text))
    parameter_file = ParameterFile(os.path.join(
        get_package_share_directory(PACKAGE), 'config', 'robot.yaml'))
    speed = ParameterValue(
        subs.PythonExpression(['float(', subs.LaunchConfiguration('speed'), ')']),
        value_type=float)
    description.add_action(launch_ros.actions.Node(
        package=PACKAGE, executable='driver', output='screen',
        parameters=[parameter_file, {'speed': speed}]))
    reporter = launch_ros.actions.Node(
        package=PACKAGE, executable='reporter', exec_name='reporter', output='both',
        parameters=[parameter_file, {'robot_name': ParameterValue(
            [subs.LaunchConfiguration('robot_name')], value_type=str)}])
    description.add_action(launch.actions.GroupAction(
        [reporter],
        condition=launch.conditions.UnlessCondition(
            subs.NotSubstitution(subs.LaunchConfiguration('report')))))
    return description
