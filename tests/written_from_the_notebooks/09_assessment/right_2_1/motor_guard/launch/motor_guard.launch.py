"""A thermometer, a smoother and a guard."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    """Return the argument hot, and the three nodes."""
    argument = DeclareLaunchArgument(
        'hot',
        description='degrees Celsius at which the fan starts',
        default_value='60.0',
    )
    thermometer = Node(package='motor_guard', executable='thermometer', name='thermometer')
    smoother = Node(package='motor_guard', executable='smoother', name='smoother')
    guard = Node(
        package='motor_guard',
        executable='guard',
        name='guard',
        parameters=[{'hot': ParameterValue(LaunchConfiguration('hot'), value_type=float)}],
    )
    return LaunchDescription([argument, thermometer, smoother, guard])
