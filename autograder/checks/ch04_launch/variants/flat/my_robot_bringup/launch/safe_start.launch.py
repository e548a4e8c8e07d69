"""Start the robot safely, with on_exit of the nodes instead of registered handlers."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, EmitEvent, LogInfo
from launch.events import Shutdown
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def node(executable, **options):
    """Return a node of this package with the name of its executable."""
    return Node(
        package='my_robot_bringup', executable=executable, name=executable, output='both',
        **options)


def generate_launch_description():
    """Return the launch description of a safe start."""
    stop = EmitEvent(event=Shutdown(reason='the robot is not to drive'))
    driver = node('driver', on_exit=[LogInfo(msg='no driver any more'), stop])

    def after_self_test(event, context):
        return driver if event.returncode == 0 else stop

    charge = ParameterValue(LaunchConfiguration('battery'), value_type=float)
    return LaunchDescription([
        DeclareLaunchArgument('battery', default_value='80', description='percent'),
        node('reporter', respawn=True, respawn_delay=0.5),
        node('self_test', parameters=[{'battery': charge}], on_exit=after_self_test),
    ])
