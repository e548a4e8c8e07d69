"""Another launch file of the package, included with arguments in a separate group."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription, LogInfo
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    single = PathJoinSubstitution([FindPackageShare("fleet"), "launch", "single.launch.py"])
    return LaunchDescription(
        [
            DeclareLaunchArgument("rate", default_value="8.0"),
            GroupAction(
                [
                    IncludeLaunchDescription(
                        PythonLaunchDescriptionSource(single),
                        launch_arguments={"name": "included", "rate": LaunchConfiguration("rate")}.items(),
                    )
                ]
            ),
            LogInfo(msg=["name is ", LaunchConfiguration("name", default="not set here")]),
        ]
    )
