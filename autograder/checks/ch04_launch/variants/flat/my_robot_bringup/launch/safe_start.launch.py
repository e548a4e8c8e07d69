"""A safe start by the nodes' own on_exit instead of handlers that are registered."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, EmitEvent, LogInfo
from launch.events import Shutdown
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def node(executable, **more):
    """Return a node of this package, named as its executable."""
    return Node(
        package='my_robot_bringup', executable=executable, name=executable, output='both', **more)


def generate_launch_description():
    """Chain the nodes."""
    stop = EmitEvent(event=Shutdown(reason='the robot is not to drive'))
    driver = node('driver', on_exit=[LogInfo(msg='no driver any more'), stop])

    def judge(event, context):
        return driver if event.returncode == 0 else stop

    charge = ParameterValue(LaunchConfiguration('battery'), value_type=float)
    return LaunchDescription([
        DeclareLaunchArgument('battery', default_value='80', description='percent'),
        node('reporter', respawn=True, respawn_delay=0.5),
        node('self_test', parameters=[{'battery': charge}], on_exit=judge),
    ])
