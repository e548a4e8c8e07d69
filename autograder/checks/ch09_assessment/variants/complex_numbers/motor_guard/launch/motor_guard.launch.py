"""Start the three nodes of the motor guard."""
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node, SetParameter
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    """Declare the argument hot, and start all nodes."""
    launch_description = LaunchDescription()
    launch_description.add_action(DeclareLaunchArgument(
        'hot', default_value='60.0', description='where the fan starts'))
    for name in 'thermometer', 'smoother':
        launch_description.add_action(Node(package='motor_guard', executable=name, name=name))
    hot = ParameterValue(LaunchConfiguration('hot'), value_type=float)
    launch_description.add_action(GroupAction([
        SetParameter('hot', hot),
        Node(package='motor_guard', executable='guard', name='guard', output='screen'),
    ]))
    return launch_description
