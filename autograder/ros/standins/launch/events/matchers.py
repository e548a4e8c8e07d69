"""Matchers for the action of an event."""

from __future__ import annotations

from collections.abc import Callable

from ..launch_description_entity import LaunchDescriptionEntity


def matches_action(target_action: LaunchDescriptionEntity) -> Callable[[object], bool]:
    """Return a matcher that is true only for `target_action`."""
    return lambda action: action is target_action
