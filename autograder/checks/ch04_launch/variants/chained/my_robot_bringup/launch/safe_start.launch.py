"""Start the robot safely, by a chain of handlers, each of which registers the next."""

from functools import partial

from launch import LaunchDescription
from launch.actions import (
    DeclareLaunchArgument, EmitEvent, OpaqueFunction, RegisterEventHandler, SetLaunchConfiguration)
from launch.event_handlers import OnProcessExit, OnProcessStart
from launch.events import Shutdown
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

node = partial(Node, package='my_robot_bringup', output='screen')


def generate_launch_description():
    """Return the launch description of a safe start."""
    percent = ParameterValue([LaunchConfiguration('percent')], value_type=float)
    reporter = node(executable='reporter', name='reporter', respawn=True, respawn_delay=0.5)
    self_test = node(executable='self_test', name='self_test', parameters=[{'battery': percent}])
    driver = node(executable='driver', name='driver', on_exit=EmitEvent(event=Shutdown(reason='no driver')))

    def after_self_test(event, context):
        return {0: [driver]}.get(event.returncode, [OpaqueFunction(function=give_up)])

    def give_up(context):
        return [EmitEvent(event=Shutdown(reason='the self-test has failed'))]

    return LaunchDescription([
        DeclareLaunchArgument('battery', default_value='80'),
        SetLaunchConfiguration('percent', LaunchConfiguration('battery')),
        RegisterEventHandler(OnProcessStart(
            target_action=self_test,
            on_start=RegisterEventHandler(OnProcessExit(target_action=self_test, on_exit=after_self_test)))),
        self_test,
        reporter,
    ])
