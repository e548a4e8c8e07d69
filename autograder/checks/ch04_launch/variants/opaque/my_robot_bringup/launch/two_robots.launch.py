"""Two robots: the groups are made once the names are known."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription, OpaqueFunction
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, ThisLaunchFileDir
from launch_ros.actions import PushROSNamespace, SetRemap


def robot(name, speed, path):
    """Return one group."""
    return GroupAction(scoped=True, actions=[
        PushROSNamespace(name),
        SetRemap(src='status', dst='/fleet/status'),
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource(path), launch_arguments={'robot_name': name, 'speed': speed}.items()),
    ])


def robots(context):
    """Return both groups."""
    first, second, speed = (LaunchConfiguration(name).perform(context) for name in ('first', 'second', 'speed'))
    path = PathJoinSubstitution([ThisLaunchFileDir(), 'robot.launch.py']).perform(context)
    return [robot(name, speed, path) for name in (first, second)]


def generate_launch_description():
    """Declare three arguments, and let a function do the rest."""
    table = {'first': ('robot1', 'its space'), 'second': ('robot2', 'its space'), 'speed': ('0.2', 'in m/s')}
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=text)
        for name, (default, text) in table.items()]
    return LaunchDescription([*arguments, OpaqueFunction(function=robots)])
