"""Start one robot; a function refuses every report except true and false."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.conditions import LaunchConfigurationEquals
from launch.substitutions import LaunchConfiguration, TextSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def refuse(context):
    """Raise an error unless report is true or false."""
    report = LaunchConfiguration('report').perform(context)
    if report not in ('true', 'false'):
        raise ValueError(f'report is {report!r}, and can be true or false alone')


def generate_launch_description():
    """Start driver and reporter."""
    share = Path(get_package_share_directory('my_robot_bringup'))
    config = str(share / 'config' / 'robot.yaml')
    name = ParameterValue(LaunchConfiguration('robot_name'), value_type=str)
    speed = ParameterValue(LaunchConfiguration('speed'), value_type=float)
    return LaunchDescription([
        DeclareLaunchArgument(
            'robot_name', default_value=[TextSubstitution(text='robot'), '1'], description='name'),
        DeclareLaunchArgument('speed', default_value='0.2', description='speed in m/s'),
        DeclareLaunchArgument('report', default_value='true', description='true or false'),
        OpaqueFunction(function=refuse),
        Node(package='my_robot_bringup', executable='driver', name='driver', output='screen',
             parameters=[config, {'speed': speed}]),
        Node(package='my_robot_bringup', executable='reporter', name='reporter', output='screen',
             parameters=[config, {'robot_name': name}],
             condition=LaunchConfigurationEquals('report', 'true')),
    ])
