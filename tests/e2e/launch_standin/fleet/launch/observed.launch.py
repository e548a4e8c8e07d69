"""A package's own launch file, and an observer that prints the parameters of its nodes."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    file = PathJoinSubstitution(
        [FindPackageShare(LaunchConfiguration("package")), "launch", LaunchConfiguration("file")]
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument("package"),
            DeclareLaunchArgument("file"),
            IncludeLaunchDescription(file),
            Node(
                package="fleet",
                executable="observer",
                arguments=["/robot_controller", "/sensor_processor", "/status_publisher"],
                output="screen",
            ),
        ]
    )
