"""Start one robot; a function that knows the arguments' values creates the nodes."""

import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

CONFIG = os.path.join(get_package_share_directory('my_robot_bringup'), 'config', 'robot.yaml')


def nodes(context):
    """Return the nodes for the arguments of a launch."""
    def argument(name):
        return LaunchConfiguration(name).perform(context)

    def node(executable, **parameters):
        return Node(
            package='my_robot_bringup', executable=executable, name=executable, output='screen',
            parameters=[CONFIG, parameters])

    entities = [node('driver', speed=float(argument('speed')))]
    if argument('report') == 'true':
        entities.append(node('reporter', robot_name=ParameterValue(argument('robot_name'), value_type=str)))
    return entities


def generate_launch_description():
    """Declare the arguments, and let the function create the nodes."""
    return LaunchDescription([
        DeclareLaunchArgument('robot_name', default_value='robot1', description='the name in its reports'),
        DeclareLaunchArgument('speed', default_value='0.2', description='metres a second'),
        DeclareLaunchArgument('report', default_value='true', choices=['false', 'true'], description='reports?'),
        OpaqueFunction(function=nodes),
    ])
