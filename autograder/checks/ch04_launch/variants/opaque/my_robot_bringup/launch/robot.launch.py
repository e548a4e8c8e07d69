"""One robot: everything is decided in a function that knows what the arguments are."""

import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

CONFIG = os.path.join(get_package_share_directory('my_robot_bringup'), 'config', 'robot.yaml')


def nodes(context):
    """Return the nodes."""
    def argument(name):
        return LaunchConfiguration(name).perform(context)

    def node(executable, **own):
        return Node(
            package='my_robot_bringup', executable=executable, name=executable, output='screen',
            parameters=[CONFIG, own])

    found = [node('driver', speed=float(argument('speed')))]
    if argument('report') == 'true':
        found.append(node('reporter', robot_name=ParameterValue(argument('robot_name'), value_type=str)))
    return found


def generate_launch_description():
    """Declare, then decide."""
    return LaunchDescription([
        DeclareLaunchArgument('robot_name', default_value='robot1', description='the name in its reports'),
        DeclareLaunchArgument('speed', default_value='0.2', description='metres a second'),
        DeclareLaunchArgument('report', default_value='true', choices=['false', 'true'], description='reports?'),
        OpaqueFunction(function=nodes),
    ])
