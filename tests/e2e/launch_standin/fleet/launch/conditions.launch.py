"""Processes with conditions."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, LogInfo
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import EqualsSubstitution, LaunchConfiguration, NotSubstitution, PythonExpression
from launch_ros.actions import Node


def generate_launch_description():
    sim = LaunchConfiguration("sim")
    return LaunchDescription(
        [
            DeclareLaunchArgument("sim", default_value="false"),
            DeclareLaunchArgument("robots", default_value="1"),
            Node(
                package="fleet",
                executable="light",
                arguments=["simulator"],
                condition=IfCondition(sim),
                output="screen",
            ),
            Node(
                package="fleet",
                executable="light",
                arguments=["driver"],
                condition=UnlessCondition(sim),
                output="screen",
            ),
            LogInfo(msg="real hardware", condition=IfCondition(NotSubstitution(sim))),
            LogInfo(msg="a fleet", condition=IfCondition(PythonExpression([LaunchConfiguration("robots"), " > 1"]))),
            LogInfo(msg="just one", condition=IfCondition(EqualsSubstitution(LaunchConfiguration("robots"), "1"))),
        ]
    )
