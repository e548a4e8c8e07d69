"""The action that takes nodes through their life cycles."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Any, ClassVar

from launch import LaunchContext, SomeSubstitutionsType
from launch.action import Action
from launch.actions import EmitEvent, OpaqueFunction
from launch.event import Event
from launch.event_handler import EventHandler
from launch.logging import get_logger
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from standin_notice import guard

from ..event_handlers import OnStateTransition
from ..events.lifecycle import ChangeState, StateTransition
from ..events.matchers import matches_node_name

# For each constant of lifecycle_msgs/msg/Transition the states, by their labels, between which it ends when it
# succeeds: the one in which the node works, the next.
_STATES = {
    1: ("configuring", "inactive"),
    2: ("cleaningup", "unconfigured"),
    3: ("activating", "active"),
    4: ("deactivating", "inactive"),
    5: ("shuttingdown", "finalized"),  # from unconfigured
    6: ("shuttingdown", "finalized"),  # from inactive
    7: ("shuttingdown", "finalized"),  # from active
}


class LifecycleTransition(Action):
    """Asks each node for the transitions in turn, for the next one when the last one has succeeded.

    A node whose transition fails with an error is asked for no more. `transition_ids` are constants of
    `lifecycle_msgs.msg.Transition`, or substitutions that give one. Raises ValueError if names or transitions are
    empty; executing it raises ValueError for a transition that is no number or has no constant, KeyError for one
    that nobody can ask for: create, destroy.
    """

    transition_targets: ClassVar = {
        transition: {"start_state": start, "goal_state": goal} for transition, (start, goal) in _STATES.items()
    }

    def __init__(
        self,
        *,
        lifecycle_node_names: Collection[SomeSubstitutionsType],
        transition_ids: Collection[int | SomeSubstitutionsType],
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        if not transition_ids:
            raise ValueError("No transition_ids provided.")
        if not lifecycle_node_names:
            raise ValueError("No lifecycle_node_names provided.")
        self._names = [normalize_to_list_of_substitutions(name) for name in lifecycle_node_names]
        self._transitions = [
            normalize_to_list_of_substitutions(str(given) if isinstance(given, int) else given)
            for given in transition_ids
        ]
        self._handlers: dict[str, list[EventHandler]] = {}

    def execute(self, context: LaunchContext) -> list[EmitEvent]:
        """Register what asks for the later transitions; return the events that ask for the first one."""
        names = [perform_substitutions(context, name) for name in self._names]
        transitions = [self._number(perform_substitutions(context, given)) for given in self._transitions]
        return [self._take_through(context, name, transitions) for name in names]

    @staticmethod
    def _number(text: str) -> int:
        try:
            return int(text)
        except ValueError:
            raise ValueError(f"expected integer for lifecycle transition, got {text}") from None

    def _take_through(self, context: LaunchContext, node_name: str, transitions: list[int]) -> EmitEvent:
        is_node = matches_node_name(node_name)
        requests = [
            EmitEvent(event=ChangeState(lifecycle_node_matcher=is_node, transition_id=transition))
            for transition in transitions
        ]

        def has_succeeded(transition: int) -> Callable[[Event], bool]:
            states = _STATES[transition]
            return lambda event: (
                isinstance(event, StateTransition)
                and is_node(event.action)
                and (event.start_state, event.goal_state) == states
            )

        def has_failed(event: Event) -> bool:
            return (
                isinstance(event, StateTransition) and is_node(event.action) and event.goal_state == "errorprocessing"
            )

        at_end = OpaqueFunction(function=self._stop, args=[node_name])
        at_failure = OpaqueFunction(function=self._stop, args=[node_name, "error occured during transitions"])
        self._handlers[node_name] = [
            *(
                OnStateTransition(matcher=has_succeeded(transition), entities=[then], handle_once=True)
                for transition, then in zip(transitions, [*requests[1:], at_end], strict=True)
            ),
            EventHandler(matcher=has_failed, entities=[at_failure], handle_once=True),
        ]
        for handler in self._handlers[node_name]:
            context.register_event_handler(handler)
        return requests[0]

    def _stop(self, context: LaunchContext, node_name: str, reason: str | None = None) -> None:
        """Take away the handlers of a node's transitions that have not been used."""
        if reason is not None:
            get_logger(__name__).info("Stopping transitions for %s because '%s'", node_name, reason)
        for handler in self._handlers.pop(node_name, ()):
            try:
                context.unregister_event_handler(handler)
            except ValueError:
                continue  # it was used: a handler for one event takes itself away


__getattr__ = guard(__name__)
