"""Start two robots, each by its own group with a namespace, a remapping and an include."""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription
from launch.launch_description_sources import AnyLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, TextSubstitution
from launch_ros.actions import PushRosNamespace, SetRemap

ROBOT_FILE = str(Path(__file__).with_name('robot.launch.py'))


def generate_launch_description():
    """Return the launch description of two robots."""
    description = LaunchDescription()
    for name, default in (('first', 'robot1'), ('second', 'robot2'), ('speed', '0.2')):
        description.add_action(DeclareLaunchArgument(
            name, default_value=TextSubstitution(text=default), description=f'the {name} of the fleet'))
    first, second = LaunchConfiguration('first'), LaunchConfiguration('second')
    group_one = GroupAction([
        PushRosNamespace(first), SetRemap('status', '/fleet/status'),
        IncludeLaunchDescription(AnyLaunchDescriptionSource(ROBOT_FILE), launch_arguments=(
            ('robot_name', first), ('speed', [LaunchConfiguration('speed')])))])
    group_two = GroupAction([
        PushRosNamespace(second), SetRemap('status', '/fleet/status'),
        IncludeLaunchDescription(AnyLaunchDescriptionSource(ROBOT_FILE), launch_arguments=(
            ('robot_name', second), ('speed', [LaunchConfiguration('speed')])))])
    description.add_action(group_one)
    description.add_action(group_two)
    return description
