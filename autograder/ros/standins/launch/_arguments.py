"""The search for the arguments that a launch description, and the descriptions that it includes, declare.

The actions derive from the base classes here, so that the search does not import the actions.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable

from .action import Action
from .launch_description_entity import LaunchDescriptionEntity
from .substitution import Substitution


class ArgumentDeclaration(Action):
    """An action that declares an argument; `launch.actions.DeclareLaunchArgument` is one."""

    name: str
    description: str
    default_value: list[Substitution] | None
    choices: Collection[str] | None
    # Set by `find_arguments`.
    _conditionally_included: bool


class ArgumentScope(Action):
    """An action that hides the arguments from outside; `ResetLaunchConfigurations` is one."""


class Inclusion(Action):
    """An action that includes another description; `launch.actions.IncludeLaunchDescription` is one."""

    def _plain_argument_names(self) -> list[str]:
        """Return the names of the given arguments that are plain text."""
        raise NotImplementedError


FoundArgument = tuple[ArgumentDeclaration, list[Inclusion]]


def find_arguments(entities: Iterable[LaunchDescriptionEntity], conditional: bool) -> list[FoundArgument]:
    """Return the declared arguments, each with the inclusions through which it was found.

    Of arguments with the same name, the first counts.

    Args:
        entities: the entities where the search starts; it continues in their sub-entities.
        conditional: whether a condition decides if the entities are visited.
    """
    arguments_by_name: dict[str, FoundArgument] = {}

    def search(entities: Iterable[LaunchDescriptionEntity], conditional: bool, inclusions: list[Inclusion]) -> None:
        for entity in entities:
            if isinstance(entity, ArgumentScope):
                return
            if isinstance(entity, ArgumentDeclaration) and entity.name not in arguments_by_name:
                entity._conditionally_included = conditional or entity.condition is not None
                arguments_by_name[entity.name] = (entity, inclusions)
            sub_inclusions = [*inclusions, entity] if isinstance(entity, Inclusion) else inclusions
            search(entity.describe_sub_entities(), conditional, sub_inclusions)
            for _, sub_entities in entity.describe_conditional_sub_entities():
                search(sub_entities, True, sub_inclusions)

    search(entities, conditional, [])
    return list(arguments_by_name.values())
