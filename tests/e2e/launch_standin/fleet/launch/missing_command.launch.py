"""A command that is nowhere on the PATH; the rest goes on."""

from launch import LaunchDescription
from launch.actions import ExecuteProcess, LogInfo


def generate_launch_description():
    return LaunchDescription([ExecuteProcess(cmd=["no-such-program", "-x"]), LogInfo(msg="goes on")])
