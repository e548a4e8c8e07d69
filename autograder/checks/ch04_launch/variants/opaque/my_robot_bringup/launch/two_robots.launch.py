"""Start two robots; a function that knows their names creates the groups."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription, OpaqueFunction
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, ThisLaunchFileDir
from launch_ros.actions import PushROSNamespace, SetRemap


def robot(name, speed, path):
    """Return the group of one robot."""
    return GroupAction(scoped=True, actions=[
        PushROSNamespace(name),
        SetRemap(src='status', dst='/fleet/status'),
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource(path), launch_arguments={'robot_name': name, 'speed': speed}.items()),
    ])


def robots(context):
    """Return the groups of both robots."""
    first, second, speed = (LaunchConfiguration(name).perform(context) for name in ('first', 'second', 'speed'))
    path = PathJoinSubstitution([ThisLaunchFileDir(), 'robot.launch.py']).perform(context)
    return [robot(name, speed, path) for name in (first, second)]


def generate_launch_description():
    """Declare the arguments, and let the function create the groups."""
    table = {'first': ('robot1', 'its space'), 'second': ('robot2', 'its space'), 'speed': ('0.2', 'in m/s')}
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=text)
        for name, (default, text) in table.items()]
    return LaunchDescription([*arguments, OpaqueFunction(function=robots)])
