"""The launch description, which a launch file returns."""

from __future__ import annotations

from collections.abc import Iterable

from ._arguments import ArgumentDeclaration, FoundArgument, find_arguments
from .action import Action
from .launch_context import LaunchContext
from .launch_description_entity import LaunchDescriptionEntity
from .logging import get_logger


class LaunchDescription(LaunchDescriptionEntity):
    """Entities that are executed in order."""

    def __init__(
        self,
        initial_entities: Iterable[LaunchDescriptionEntity] | None = None,
        *,
        deprecated_reason: str | None = None,
    ) -> None:
        self.entities: list[LaunchDescriptionEntity] = list(initial_entities or ())
        self.deprecated_reason = deprecated_reason

    @property
    def deprecated(self) -> bool:
        """Whether executing it logs a warning."""
        return self.deprecated_reason is not None

    def add_entity(self, entity: LaunchDescriptionEntity) -> None:
        """Add an entity at the end."""
        self.entities.append(entity)

    def add_action(self, action: Action) -> None:
        """Add an action at the end."""
        self.add_entity(action)

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Return the entities."""
        if self.deprecated_reason is not None:
            path = context.get_locals_as_dict().get("current_launch_file_path")
            subject = "deprecated launch description" if path is None else f"launch file [{path}] is deprecated"
            get_logger("launch").warning("%s: %s", subject, self.deprecated_reason)
        return self.entities

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the entities."""
        return self.entities

    def get_launch_arguments(self, conditional_inclusion: bool = False) -> list[ArgumentDeclaration]:
        """Return the declared arguments, including those of included launch files that can be loaded."""
        arguments = self.get_launch_arguments_with_include_launch_description_actions(conditional_inclusion)
        return [argument for argument, _ in arguments]

    def get_launch_arguments_with_include_launch_description_actions(
        self, conditional_inclusion: bool = False
    ) -> list[FoundArgument]:
        """Return the declared arguments, each with the includes through which it was found.

        Of arguments with the same name, the first counts.
        """
        return find_arguments(self.entities, conditional_inclusion)
