"""Event handlers, which match events and return entities to execute."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from .action import Action
from .event import Event
from .launch_context import LaunchContext
from .launch_description_entity import LaunchDescriptionEntity, OptionalEntities, SomeEntitiesType

EventCallback = Callable[[Event, LaunchContext], OptionalEntities]
ActionMatcher = Callable[[Action], bool]


class BaseEventHandler:
    """The base of all event handlers: a matcher, and whether to handle only one event."""

    def __init__(self, *, matcher: Callable[[Event], bool], handle_once: bool = False) -> None:
        self._matcher = matcher
        self.handle_once = handle_once

    @property
    def handler_description(self) -> str | None:
        """A description of what the handler does."""
        return None

    @property
    def matcher_description(self) -> str | None:
        """A description of the events that it handles."""
        return None

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        """Return a description, and the entities that are known in advance."""
        return (
            f"{type(self).__name__}(matcher='{self.matcher_description}', "
            f"handler='{self.handler_description}', handle_once={self.handle_once})",
            [],
        )

    def matches(self, event: Event) -> bool:
        """Return whether this handler matches `event`."""
        return self._matcher(event)

    def handle(self, event: Event, context: LaunchContext) -> OptionalEntities:
        """Handle `event`, which entities can read as ``context.locals.event``."""
        context.extend_locals({"event": event})
        if self.handle_once:
            context.unregister_event_handler(self)
        return None


class EventHandler(BaseEventHandler):
    """A handler that returns the same entities for each event."""

    def __init__(
        self,
        *,
        matcher: Callable[[Event], bool],
        entities: SomeEntitiesType | None = None,
        handle_once: bool = False,
    ) -> None:
        super().__init__(matcher=matcher, handle_once=handle_once)
        self.entities = entities

    def handle(self, event: Event, context: LaunchContext) -> OptionalEntities:
        """Return the entities."""
        super().handle(event, context)
        return self.entities


class OnActionEventBase(BaseEventHandler):
    """A handler of events that come from an action: one action, those that a callable accepts, or all.

    `on_event` is the entities to execute, or a callable that gets the event and the context and may return entities.
    """

    def __init__(
        self,
        *,
        action_matcher: Action | ActionMatcher | None,
        on_event: SomeEntitiesType | EventCallback,
        target_event_cls: type[Event],
        target_action_cls: type[Action],
        handle_once: bool = False,
    ) -> None:
        if not (action_matcher is None or isinstance(action_matcher, target_action_cls) or callable(action_matcher)):
            raise TypeError(
                f"action_matcher must be an '{target_action_cls.__name__}' instance or a callable, "
                f"got {type(action_matcher).__name__}"
            )

        def matcher(event: Event) -> bool:
            if not isinstance(event, target_event_cls):
                return False
            source: Action = event.action  # type: ignore[attr-defined]  # all of these events have one
            if callable(action_matcher):
                return action_matcher(source)
            return action_matcher is None or action_matcher is source

        super().__init__(matcher=matcher, handle_once=handle_once)
        self._description = f"event == {target_event_cls.__name__}"
        if action_matcher is not None:
            self._description += f" and {target_action_cls.__name__}(event.action)"
        self._callback, self._entities = split_callback(on_event)

    @property
    def handler_description(self) -> str:
        """A description of what the handler does."""
        return f"{self._callback}" if self._callback else "<actions>"

    @property
    def matcher_description(self) -> str:
        """A description of the events that it handles."""
        return self._description

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        """Return a description, and the entities that are known in advance."""
        return super().describe()[0], list(self._entities)

    def handle(self, event: Event, context: LaunchContext) -> OptionalEntities:
        """Return the entities, or the return value of the callable."""
        super().handle(event, context)
        return self._callback(event, context) if self._callback else self._entities


def split_callback(
    on_event: SomeEntitiesType | EventCallback,
) -> tuple[EventCallback | None, list[LaunchDescriptionEntity]]:
    """Return a callable and an empty list, or None and a list of entities.

    Raises TypeError if it is neither.
    """
    if isinstance(on_event, LaunchDescriptionEntity):
        return None, [on_event]
    if isinstance(on_event, Iterable):
        entities = list(on_event)
        for entity in entities:
            if not isinstance(entity, LaunchDescriptionEntity):
                raise TypeError(
                    "expected all items in 'on_event' iterable to be of type 'LaunchDescriptionEntity' "
                    f"but got '{type(entity)}'"
                )
        return None, entities
    if not callable(on_event):
        raise TypeError(f"expected entities or a callable to handle an event with, got '{type(on_event)}'")
    return on_event, []
