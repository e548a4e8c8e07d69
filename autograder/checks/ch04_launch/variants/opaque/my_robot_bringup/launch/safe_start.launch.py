"""Start the robot safely, with one handler for every process that ends."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction, RegisterEventHandler, Shutdown
from launch.event_handlers import OnProcessExit
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    """Return the launch description of a safe start."""
    driver = Node(package='my_robot_bringup', executable='driver', name='driver')
    reporter = Node(
        package='my_robot_bringup', executable='reporter', name='reporter', respawn=True, respawn_delay=0.5)

    def start(context):
        percent = float(LaunchConfiguration('battery').perform(context))
        self_test = Node(
            package='my_robot_bringup', executable='self_test', name='self_test', parameters=[{'battery': percent}])

        def on_process_exit(event, context):
            if event.action is self_test and event.returncode == 0:
                return driver
            if event.action in (self_test, driver):
                return Shutdown(reason=f'{event.process_name} has ended')
            return None

        return [RegisterEventHandler(OnProcessExit(on_exit=on_process_exit)), self_test]

    return LaunchDescription([
        DeclareLaunchArgument('battery', default_value='80', description='in percent'),
        reporter,
        OpaqueFunction(function=start),
    ])
