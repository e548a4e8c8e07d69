"""The three nodes in a group, with an expression that computes the guard's threshold."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction
from launch.substitutions import LaunchConfiguration, PythonExpression
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    """Return the argument and the group of the three nodes."""
    hot = ParameterValue(PythonExpression(['float(', LaunchConfiguration('hot'), ')']), value_type=float)
    return LaunchDescription([
        DeclareLaunchArgument('hot', default_value='60.0', description='degrees Celsius'),
        GroupAction([
            Node(package='motor_guard', executable='thermometer', name='thermometer'),
            Node(package='motor_guard', executable='smoother', name='smoother'),
            Node(package='motor_guard', executable='guard', name='guard', parameters=[{'hot': hot}]),
        ]),
    ])
