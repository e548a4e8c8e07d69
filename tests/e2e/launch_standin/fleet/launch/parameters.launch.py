"""Parameters for all nodes, from a file with substitutions, and from an argument."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, SetEnvironmentVariable
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node, SetParameter
from launch_ros.parameter_descriptions import ParameterFile, ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    templated = ParameterFile(
        PathJoinSubstitution([FindPackageShare("fleet"), "config", "templated.yaml"]), allow_substs=True
    )
    robot = LaunchConfiguration("robot")
    return LaunchDescription(
        [
            DeclareLaunchArgument("robot", default_value="e3"),
            SetEnvironmentVariable("COURSE_SITE", "the harness"),
            SetParameter("rate", 9.0),
            Node(package="fleet", executable="beacon", name="a", parameters=[templated], output="screen"),
            Node(
                package="fleet",
                executable="beacon",
                name="b",
                parameters=[{"rate": 3.0, "label": ParameterValue(robot, value_type=str)}],
                output="screen",
            ),
        ]
    )
