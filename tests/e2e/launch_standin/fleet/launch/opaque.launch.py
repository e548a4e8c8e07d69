"""A function that creates as many processes as an argument says, at launch time."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def robots(context):
    number = int(LaunchConfiguration("robots").perform(context))
    return [
        Node(package="fleet", executable="light", name=f"robot{index}", namespace=f"r{index}", output="screen")
        for index in range(number)
    ]


def generate_launch_description():
    return LaunchDescription([DeclareLaunchArgument("robots", default_value="2"), OpaqueFunction(function=robots)])
