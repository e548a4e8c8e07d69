"""The event handlers that do not depend on a class of actions: completion, the end of the launch, and inclusion.

Actions import this module, and it imports no actions. `launch.event_handlers` adds the handlers of processes, which do.
"""

from __future__ import annotations

from typing import cast

from .action import Action
from .event import Event
from .event_handler import ActionMatcher, BaseEventHandler, EventCallback, OnActionEventBase, split_callback
from .events import ExecutionComplete, IncludeLaunchDescription, Shutdown
from .launch_context import LaunchContext
from .launch_description_entity import LaunchDescriptionEntity, OptionalEntities, SomeEntitiesType


class OnExecutionComplete(OnActionEventBase):
    """Handle the completion of an action."""

    def __init__(
        self,
        *,
        target_action: Action | ActionMatcher | None = None,
        on_completion: SomeEntitiesType | EventCallback,
        handle_once: bool = False,
    ) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_completion,
            target_event_cls=ExecutionComplete,
            target_action_cls=Action,
            handle_once=handle_once,
        )


class OnShutdown(BaseEventHandler):
    """Handle the end of the launch."""

    def __init__(self, *, on_shutdown: SomeEntitiesType | EventCallback, handle_once: bool = False) -> None:
        super().__init__(matcher=lambda event: isinstance(event, Shutdown), handle_once=handle_once)
        self._callback, self._entities = split_callback(on_shutdown)

    @property
    def matcher_description(self) -> str:
        """A description of the events that it handles."""
        return "event is Shutdown"

    @property
    def handler_description(self) -> str:
        """A description of what the handler does."""
        return f"{self._callback}" if self._callback else "<actions>"

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        """Return a description, and the entities that are known in advance."""
        return super().describe()[0], list(self._entities)

    def handle(self, event: Event, context: LaunchContext) -> OptionalEntities:
        """Return the entities, or the return value of the callable."""
        super().handle(event, context)
        return self._callback(event, context) if self._callback else self._entities


class OnIncludeLaunchDescription(BaseEventHandler):
    """Execute the launch description of an event."""

    def __init__(self) -> None:
        super().__init__(matcher=lambda event: isinstance(event, IncludeLaunchDescription))

    def handle(self, event: Event, context: LaunchContext) -> OptionalEntities:
        """Return the launch description."""
        super().handle(event, context)
        return cast(IncludeLaunchDescription, event).launch_description
