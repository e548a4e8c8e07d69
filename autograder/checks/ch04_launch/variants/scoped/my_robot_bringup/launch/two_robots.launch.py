"""Start two robots; name and speed are launch configurations of each group."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import PushRosNamespace, SetRemap
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    """Return the launch description of two robots."""
    path = PathJoinSubstitution([FindPackageShare('my_robot_bringup'), 'launch', 'robot.launch.py'])

    def robot(argument):
        return GroupAction(
            [
                PushRosNamespace(LaunchConfiguration('robot_name')),
                SetRemap('status', '/fleet/status'),
                IncludeLaunchDescription(path),
            ],
            launch_configurations={
                'robot_name': LaunchConfiguration(argument), 'speed': LaunchConfiguration('speed')},
        )

    return LaunchDescription([
        DeclareLaunchArgument('first', default_value='robot1', description='first namespace'),
        DeclareLaunchArgument('second', default_value='robot2', description='second namespace'),
        DeclareLaunchArgument('speed', default_value='0.2', description='both speeds (m/s)'),
        robot('first'),
        robot('second'),
    ])
