"""The same launch, with a path of the operating system's."""

import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
import launch_ros.actions


def generate_launch_description():
    """Run the node."""
    share = get_package_share_directory('speed_guard')
    description = LaunchDescription()
    description.add_action(launch_ros.actions.Node(
        package='speed_guard',
        executable='speed_guard',
        name='speed_guard',
        output='both',
        parameters=[os.path.join(share, 'config', 'guard.yaml')],
    ))
    return description
