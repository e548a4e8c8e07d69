"""Processes with different destinations of output, environments and prefixes."""

import sys

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import EnvironmentVariable, LaunchConfiguration

SPEAK = """
import os, sys
print("tty" if os.isatty(1) else "pipe", *sys.argv[1:])
print("error", *sys.argv[1:], file=sys.stderr)
"""


def generate_launch_description():
    def speak(name, **more):
        return ExecuteProcess(cmd=[sys.executable, "-c", SPEAK, name], name=name, **more)

    return LaunchDescription(
        [
            DeclareLaunchArgument("word", default_value="hello"),
            speak("to-screen", output="screen"),
            speak("to-log"),
            speak("mixed", output={"stdout": "screen", "stderr": "own_log"}),
            speak("in-terminal", output="screen", emulate_tty=True),
            speak("formatted", output="screen", output_format="<{line}>"),
            ExecuteProcess(
                cmd=["echo", "$COURSE_WORD", "and", LaunchConfiguration("word")],
                shell=True,
                output="screen",
                additional_env={"COURSE_WORD": [LaunchConfiguration("word"), "!"]},
                log_cmd=True,
            ),
            ExecuteProcess(cmd=["printenv"], env={"ONLY": EnvironmentVariable("HOME")}, output="screen"),
            ExecuteProcess(
                cmd=["sh", "-c", "echo $COURSE_PREFIXED"], prefix="env COURSE_PREFIXED=yes", output="screen"
            ),
            ExecuteProcess(cmd=["pwd"], cwd="/", output="both"),
            ExecuteProcess(cmd=["printf", "no line end"], output="screen"),
        ]
    )
