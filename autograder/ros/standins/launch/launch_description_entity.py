"""The base of everything that a launch description may contain."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable

from .launch_context import LaunchContext


class LaunchDescriptionEntity:
    """The base class of entities, which can be visited, described and awaited."""

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Execute the entity; return further entities to visit."""
        return None

    def describe(self) -> str:
        """Return a description of the entity."""
        return self.__repr__()

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the entities that will be visited with this one."""
        return []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """Return the entities that may be visited, each group with a description of its condition."""
        return []

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        """Return a future that is done when the entity is, or None if the entity is done immediately."""
        return None


SomeEntitiesType = LaunchDescriptionEntity | Iterable[LaunchDescriptionEntity]
OptionalEntities = SomeEntitiesType | None
