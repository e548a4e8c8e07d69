"""A timer by simulated time: 30 s of it pass in three."""

from launch import LaunchDescription
from launch.actions import LogInfo, Shutdown
from launch_ros.actions import Node, RosTimer, SetParameter, SetUseSimTime


def generate_launch_description():
    return LaunchDescription(
        [
            Node(package="fleet", executable="clock"),
            SetUseSimTime(True),  # for the timer
            SetParameter("use_sim_time", True),  # for the nodes
            Node(package="fleet", executable="beacon", output="screen"),
            RosTimer(period=30.0, actions=[LogInfo(msg="half a minute"), Shutdown()]),
        ]
    )
