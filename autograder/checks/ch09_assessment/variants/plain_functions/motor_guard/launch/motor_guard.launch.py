"""The three nodes, one after the other."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def make(context):
    """Make the nodes once the argument is known."""
    hot = float(LaunchConfiguration("hot").perform(context))
    return [
        Node(package="motor_guard", executable="guard", parameters=[{"hot": hot}]),
        Node(package="motor_guard", executable="smoother"),
        Node(package="motor_guard", executable="thermometer"),
    ]


def generate_launch_description():
    """Declare the argument and make the nodes later."""
    return LaunchDescription(
        [
            DeclareLaunchArgument("hot", default_value="60.0"),
            OpaqueFunction(function=make),
        ]
    )
