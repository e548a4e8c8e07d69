"""Handlers for the events start, output, exit and shutdown."""

from launch import LaunchDescription
from launch.actions import EmitEvent, ExecuteProcess, LogInfo, RegisterEventHandler, Shutdown
from launch.event_handlers import OnExecutionComplete, OnProcessExit, OnProcessIO, OnProcessStart, OnShutdown
from launch.events import matches_action
from launch.events.process import ShutdownProcess
from launch.substitutions import LocalSubstitution
from launch_ros.actions import Node


def generate_launch_description():
    first = Node(package="fleet", executable="light", arguments=["first"], output="screen")
    second = Node(package="fleet", executable="light", arguments=["second"], output="screen")
    listing = ExecuteProcess(cmd=["sh", "-c", "echo listing; exit 7"], output="screen")

    def on_second_writes(event):
        if b"second" in event.text:
            return [
                LogInfo(msg="second is up"),
                EmitEvent(event=ShutdownProcess(process_matcher=matches_action(second))),
            ]
        return None

    def on_second_exits(event, context):
        return [LogInfo(msg=f"second exited with {event.returncode}"), listing]

    return LaunchDescription(
        [
            first,
            RegisterEventHandler(OnProcessStart(target_action=first, on_start=[LogInfo(msg="first started"), second])),
            RegisterEventHandler(OnProcessIO(target_action=second, on_stdout=on_second_writes)),
            RegisterEventHandler(OnProcessExit(target_action=second, on_exit=on_second_exits)),
            RegisterEventHandler(
                OnProcessExit(
                    target_action=listing,
                    on_exit=[
                        LogInfo(msg=["it was ", LocalSubstitution("event.process_name")]),
                        Shutdown(reason="that is all"),
                    ],
                )
            ),
            RegisterEventHandler(
                OnExecutionComplete(target_action=listing, on_completion=lambda event, context: LogInfo(msg="complete"))
            ),
            RegisterEventHandler(
                OnShutdown(on_shutdown=[LogInfo(msg=["the end: ", LocalSubstitution("event.reason")])])
            ),
        ]
    )
