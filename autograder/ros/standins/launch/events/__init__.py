"""The events of the launch system itself; those of processes are in `launch.events.process`."""

from __future__ import annotations

from standin_notice import make_getattr

from ..event import Event
from ..launch_description_entity import LaunchDescriptionEntity
from . import matchers, process
from .matchers import matches_action

__all__ = [
    "ExecutionComplete",
    "IncludeLaunchDescription",
    "Shutdown",
    "TimerEvent",
    "matchers",
    "matches_action",
    "process",
]


class Shutdown(Event):
    """A request to end the launch and all its processes."""

    name = "launch.events.Shutdown"

    def __init__(self, *, reason: str = "reason not given", due_to_sigint: bool = False) -> None:
        self.reason = reason
        self.due_to_sigint = due_to_sigint


class ExecutionComplete(Event):
    """An action has been executed, and its future is done."""

    name = "launch.events.ExecutionComplete"

    def __init__(self, *, action: LaunchDescriptionEntity) -> None:
        self.action = action


class IncludeLaunchDescription(Event):
    """A request to execute a launch description."""

    name = "launch.events.IncludeLaunchDescription"

    def __init__(self, launch_description: LaunchDescriptionEntity) -> None:
        self.launch_description = launch_description


class TimerEvent(Event):
    """The period of a timer action is over."""

    name = "launch.events.TimerEvent"

    def __init__(self, *, timer_action: LaunchDescriptionEntity) -> None:
        self.timer_action = timer_action


__getattr__ = make_getattr(__name__)
