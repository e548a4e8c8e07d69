"""The event handler for nodes with a life cycle."""

from __future__ import annotations

from collections.abc import Callable

from launch.event import Event
from launch.event_handler import EventHandler
from launch.launch_description_entity import SomeEntitiesType
from standin_notice import guard

from .actions.lifecycle_node import LifecycleNode
from .events.lifecycle import StateTransition

__all__ = ["OnStateTransition"]

__getattr__ = guard(__name__)


class OnStateTransition(EventHandler):
    """Yields `entities` when a node has changed its state.

    What is not None must be so: the node, the label of the transition, of the state before, of the state after. With
    `matcher`, that alone decides. Raises RuntimeError if `target_lifecycle_node` is no `LifecycleNode`.
    """

    def __init__(
        self,
        *,
        entities: SomeEntitiesType,
        target_lifecycle_node: LifecycleNode | None = None,
        transition: str | None = None,
        start_state: str | None = None,
        goal_state: str | None = None,
        matcher: Callable[[Event], bool] | None = None,
        handle_once: bool = False,
    ) -> None:
        if not isinstance(target_lifecycle_node, (LifecycleNode, type(None))):
            raise RuntimeError("OnStateTransition requires a 'LifecycleNode' action as the target")

        def is_wanted(event: Event) -> bool:
            return isinstance(event, StateTransition) and all(
                wanted is None or found == wanted
                for wanted, found in (
                    (target_lifecycle_node, event.action),
                    (transition, event.transition),
                    (start_state, event.start_state),
                    (goal_state, event.goal_state),
                )
            )

        super().__init__(matcher=matcher or is_wanted, entities=entities, handle_once=handle_once)
        self._target = target_lifecycle_node

    @property
    def handler_description(self) -> str:
        """What the handler does, in words."""
        return "<actions>"

    @property
    def matcher_description(self) -> str:
        """Which events it handles, in words."""
        if self._target is None:
            return "event == StateTransition"
        return f"event == StateTransition and event.action == LifecycleNode({hex(id(self._target))})"
