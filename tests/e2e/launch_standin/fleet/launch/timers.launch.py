"""Timers that fire, and one that is cancelled."""

from launch import LaunchDescription
from launch.actions import LogInfo, OpaqueFunction, TimerAction


def generate_launch_description():
    never = TimerAction(period=3600.0, actions=[LogInfo(msg="never")])
    return LaunchDescription(
        [
            TimerAction(period="0.2", actions=[LogInfo(msg="second")]),
            TimerAction(period=0.05, actions=[LogInfo(msg="first")]),
            TimerAction(
                period=0.4, actions=[LogInfo(msg="third"), OpaqueFunction(function=lambda context: never.cancel())]
            ),
            never,
        ]
    )
