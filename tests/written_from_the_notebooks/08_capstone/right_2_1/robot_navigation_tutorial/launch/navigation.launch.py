"""The robot's navigation: a processor, a controller and a monitor."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    """Return two arguments and three nodes."""
    package = 'robot_navigation_tutorial'
    description = LaunchDescription()
    description.add_action(DeclareLaunchArgument(
        'params_file',
        default_value=PathJoinSubstitution(
            [FindPackageShare(package), 'config', 'navigation.yaml']),
        description="The file with the nodes' parameters",
    ))
    description.add_action(DeclareLaunchArgument(
        'use_sim_time',
        default_value='false',
        description='Whether the time comes from a simulator',
    ))
    parameters = [
        LaunchConfiguration('params_file'),
        {'use_sim_time': LaunchConfiguration('use_sim_time')},
    ]
    for executable in 'sensor_processor', 'navigation_controller', 'status_monitor':
        description.add_action(Node(
            package=package,
            executable=executable,
            name=executable,
            output='screen',
            parameters=parameters,
        ))
    return description
