"""Start one robot; parameters are set for a scope, and the condition is a substitution."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction
from launch.conditions import IfCondition
from launch.substitutions import EqualsSubstitution, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node, SetParameter, SetParametersFromFile
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    """Return the nodes, nested in scopes with parameters."""
    config = PathJoinSubstitution([FindPackageShare('my_robot_bringup'), 'config', 'robot.yaml'])
    speed = ParameterValue(LaunchConfiguration('speed', default='0.2'), value_type=float)
    name = ParameterValue(LaunchConfiguration('robot_name'), value_type=str)
    return LaunchDescription([
        DeclareLaunchArgument('report', default_value='true', choices=['true', 'false'],
                              description='start the reporter'),
        DeclareLaunchArgument('speed', default_value='0.2', description='speed (m/s)'),
        DeclareLaunchArgument('robot_name', default_value='robot1', description='name'),
        GroupAction([
            SetParametersFromFile(config),
            GroupAction([
                SetParameter('speed', speed),
                Node(package='my_robot_bringup', executable='driver', name='driver', output={'both': 'screen'}),
            ]),
            Node(
                package='my_robot_bringup', executable='reporter', name='reporter', output='both',
                parameters=[{'robot_name': name}],
                condition=IfCondition(EqualsSubstitution(LaunchConfiguration('report'), 'true'))),
        ]),
    ])
