"""The base class of all actions."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from ._readers import READERS
from .condition import Condition
from .events import ExecutionComplete
from .launch_context import LaunchContext
from .launch_description_entity import LaunchDescriptionEntity, OptionalEntities

if TYPE_CHECKING:
    from .frontend import Entity, Parser


class Action(LaunchDescriptionEntity):
    """An action with an optional condition; an ExecutionComplete event is emitted when it is done."""

    def __init__(self, *, condition: Condition | None = None) -> None:
        if condition is not None and not isinstance(condition, Condition):
            raise TypeError(
                f"{type(self).__name__}: condition must be a launch.Condition such as IfCondition(...), "
                f"got {type(condition).__name__}"
            )
        self.__condition = condition

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and its keyword arguments, read from an element of an XML or YAML launch file."""
        read = next(READERS[base] for base in cls.__mro__ if base in READERS)
        return cls, {**read(entity, parser), **READERS[Action](entity, parser)}

    @property
    def condition(self) -> Condition | None:
        """The condition under which the action is executed."""
        return self.__condition

    def describe(self) -> str:
        """Return a description of the action."""
        return f"{type(self).__name__}('{hex(id(self))}')"

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the entities that executing this action may return."""
        return []

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the sub-entities of an action without a condition."""
        return self.get_sub_entities() if self.__condition is None else []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """Return the sub-entities of an action with a condition."""
        if self.__condition is None:
            return []
        return [(f"Conditionally included by {self.describe()}", self.get_sub_entities())]

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Execute the action if its condition holds."""
        if self.__condition is not None and not self.__condition.evaluate(context):
            return None
        try:
            return as_list(self.execute(context))
        finally:
            self.__announce_completion(context)

    def __announce_completion(self, context: LaunchContext) -> None:
        event = ExecutionComplete(action=self)
        if not context.would_handle_event(event):
            return
        future = self.get_asyncio_future()
        if future is None:
            context.emit_event_sync(event)
        else:
            future.add_done_callback(lambda _: context.emit_event_sync(event))

    def execute(self, context: LaunchContext) -> OptionalEntities:
        """Execute the action; return entities to visit next."""
        return None


def as_list(entities: OptionalEntities) -> list[LaunchDescriptionEntity] | None:
    """Return one or several entities as a list, or None for None."""
    if entities is None:
        return None
    return [entities] if isinstance(entities, LaunchDescriptionEntity) else list(entities)


def running_loop(context: LaunchContext) -> asyncio.AbstractEventLoop:
    """Return the event loop of the running launch; raise RuntimeError if the launch is not running."""
    if context.asyncio_loop is None:
        raise RuntimeError("the launch context has no event loop: it is used outside of a running LaunchService")
    return context.asyncio_loop
