"""The event that asks nodes to change their states."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

from launch.event import Event


class ChangeState(Event):
    """Asks every node whose action `lifecycle_node_matcher` accepts for a transition.

    `transition_id` is a constant of `lifecycle_msgs.msg.Transition`. Raises ValueError if it is not one of
    `valid_transitions`.
    """

    name = "launch_ros.events.lifecycle.ChangeState"
    # The constants of lifecycle_msgs/msg/Transition and lifecycle_msgs/msg/State.
    _TRANSITIONS = (
        "TRANSITION_CREATE",
        "TRANSITION_CONFIGURE",
        "TRANSITION_CLEANUP",
        "TRANSITION_ACTIVATE",
        "TRANSITION_DEACTIVATE",
        "TRANSITION_UNCONFIGURED_SHUTDOWN",
        "TRANSITION_INACTIVE_SHUTDOWN",
        "TRANSITION_ACTIVE_SHUTDOWN",
        "TRANSITION_DESTROY",
    )
    valid_transitions: ClassVar = dict(enumerate(_TRANSITIONS))
    _PRIMARY = (
        "PRIMARY_STATE_UNKNOWN",
        "PRIMARY_STATE_UNCONFIGURED",
        "PRIMARY_STATE_INACTIVE",
        "PRIMARY_STATE_ACTIVE",
        "PRIMARY_STATE_FINALIZED",
    )
    _BETWEEN = (
        "TRANSITION_STATE_CONFIGURING",
        "TRANSITION_STATE_CLEANINGUP",
        "TRANSITION_STATE_SHUTTINGDOWN",
        "TRANSITION_STATE_ACTIVATING",
        "TRANSITION_STATE_DEACTIVATING",
        "TRANSITION_STATE_ERRORPROCESSING",
    )
    valid_states: ClassVar = {**dict(enumerate(_PRIMARY)), **dict(enumerate(_BETWEEN, 10))}

    def __init__(self, *, lifecycle_node_matcher: Callable[[Any], bool], transition_id: int) -> None:
        super().__init__()
        if transition_id not in self.valid_transitions:
            expected = ", ".join(f"{name}: {number}" for number, name in self.valid_transitions.items())
            raise ValueError(f"given transition_id of '{transition_id}', expected one of {{{expected}}}")
        self.lifecycle_node_matcher = lifecycle_node_matcher
        self.transition_id = transition_id
