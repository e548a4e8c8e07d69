"""Start the three nodes of the navigation together."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node, SetParameter, SetParametersFromFile
from launch_ros.substitutions import FindPackageShare

PACKAGE = 'robot_navigation_tutorial'


def generate_launch_description():
    """Return two arguments and the group of nodes, whose scope sets their parameters."""
    file = PathJoinSubstitution([FindPackageShare(PACKAGE), 'config', 'navigation.yaml'])

    def node(name):
        return Node(package=PACKAGE, executable=name, name=name, output='screen')

    return LaunchDescription([
        DeclareLaunchArgument(
            'use_sim_time', default_value='false', description='whether /clock is the clock'),
        DeclareLaunchArgument(
            'params_file', default_value=file, description='the parameters of all nodes'),
        GroupAction([
            SetParametersFromFile(LaunchConfiguration('params_file')),
            SetParameter('use_sim_time', LaunchConfiguration('use_sim_time')),
            node('status_monitor'), node('navigation_controller'), node('sensor_processor'),
        ]),
    ])
