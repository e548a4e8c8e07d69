"""Three robots in separate namespaces, with a common parameter file and two remappings."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import GroupAction
from launch_ros.actions import Node, PushRosNamespace, SetRemap


def generate_launch_description():
    config = str(Path(get_package_share_directory("fleet"), "config", "fleet.yaml"))

    def beacon(**more):
        return Node(package="fleet", executable="beacon", name="beacon", parameters=[config], output="screen", **more)

    return LaunchDescription(
        [
            GroupAction([PushRosNamespace("robot1"), SetRemap("beat", "pulse"), beacon()]),
            GroupAction([PushRosNamespace("robot2"), beacon()]),
            beacon(namespace="robot3", remappings=[("beat", "/shared/beat")]),
        ]
    )
