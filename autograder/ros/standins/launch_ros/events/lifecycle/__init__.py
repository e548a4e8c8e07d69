"""The events of nodes with a life cycle: a state is to be changed, a state has changed."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

from standin_notice import guard

from ..matchers import matches_node_name as _matches_node_name
from .change_state import ChangeState
from .state_transition import StateTransition

__all__ = ["ChangeState", "StateTransition", "matches_node_name"]

__getattr__ = guard(__name__)


def matches_node_name(node_name: str) -> Callable[[Any], bool]:
    """Return what `launch_ros.events.matchers.matches_node_name` returns, with Jazzy's warning."""
    warnings.warn(
        "'matches_node_name' has been moved into the 'launch.events' module and will be removed "
        "from the 'lifecycle' module in the future",
        stacklevel=2,
    )
    return _matches_node_name(node_name)
