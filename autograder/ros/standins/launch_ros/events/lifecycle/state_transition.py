"""The event that says that a node has changed its state."""

from __future__ import annotations

from typing import Any

from launch.action import Action
from launch.event import Event


class StateTransition(Event):
    """The node of `action`, a `launch_ros.actions.LifecycleNode`, has said by `msg` that its state changed.

    `msg` is a `lifecycle_msgs.msg.TransitionEvent`. `transition`, `start_state` and `goal_state` are its labels,
    such as ``configure``, ``configuring``, ``inactive``; `timestamp` is in nanoseconds, or 0.
    """

    name = "launch_ros.events.lifecycle.StateTransition"

    def __init__(self, *, action: Action, msg: Any) -> None:
        super().__init__()
        self.action = action
        self.msg = msg
        self.timestamp: int = msg.timestamp
        self.transition: str = msg.transition.label
        self.start_state: str = msg.start_state.label
        self.goal_state: str = msg.goal_state.label
