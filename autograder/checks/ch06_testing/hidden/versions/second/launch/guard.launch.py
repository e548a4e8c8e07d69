"""The same launch file, with a path instead of a substitution."""

from pathlib import Path

import launch_ros.actions
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription


def generate_launch_description():
    """Run the node."""
    config = Path(get_package_share_directory("speed_guard")) / "config" / "guard.yaml"
    description = LaunchDescription()
    guard = {"package": "speed_guard", "executable": "speed_guard", "name": "speed_guard"}
    description.add_action(launch_ros.actions.Node(**guard, output="both", parameters=[str(config)]))
    return description
