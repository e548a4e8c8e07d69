"""The matcher of a node's name."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


def matches_node_name(node_name: str) -> Callable[[Any], bool]:
    """Return a function that says whether an action, a `launch_ros.actions.Node`, runs the node of this name.

    A name without a leading slash is one in the root namespace.
    """
    full_name = node_name if node_name.startswith("/") else f"/{node_name}"
    return lambda action: bool(action.node_name == full_name)
