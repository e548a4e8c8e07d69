"""Launches the three nodes with an opaque function."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def make_nodes(context):
    """Return the nodes, with the value of the argument."""
    hot = float(LaunchConfiguration("hot").perform(context))
    return [
        Node(package="motor_guard", executable="guard", parameters=[{"hot": hot}]),
        Node(package="motor_guard", executable="smoother"),
        Node(package="motor_guard", executable="thermometer"),
    ]


def generate_launch_description():
    """Return the argument and a function that creates the nodes."""
    return LaunchDescription(
        [
            DeclareLaunchArgument("hot", default_value="60.0"),
            OpaqueFunction(function=make_nodes),
        ]
    )
