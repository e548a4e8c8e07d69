"""Start two robots; paths and namespaces are substitutions."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import PushRosNamespace, SetRemap
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    """Return the launch description with one group for each robot."""
    robot = PathJoinSubstitution(
        [FindPackageShare('my_robot_bringup'), 'launch', 'robot.launch.py'])
    entities = [
        DeclareLaunchArgument(
            'speed', default_value='0.2', description='of both robots, in m/s'),
    ]
    for argument, default in (('first', 'robot1'), ('second', 'robot2')):
        name = LaunchConfiguration(argument)
        entities += [
            DeclareLaunchArgument(
                argument, default_value=default, description=f'namespace of the {argument} robot'),
            GroupAction([
                SetRemap(src='status', dst='/fleet/status'),
                PushRosNamespace(['/', name]),
                IncludeLaunchDescription(robot, launch_arguments=[
                    ('speed', LaunchConfiguration('speed')), ('robot_name', name)]),
            ]),
        ]
    return LaunchDescription(entities)
