"""How a launch description finds the arguments that it and the descriptions it includes declare.

The actions in question derive from the bases here, so that a description need not import the actions.
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
    """An action after which arguments from outside are not seen; `ResetLaunchConfigurations` is one."""


class Inclusion(Action):
    """An action that includes another description; `launch.actions.IncludeLaunchDescription` is one."""

    def _plain_argument_names(self) -> list[str]:
        """Return the names of those arguments that are given and need no context."""
        raise NotImplementedError


FoundArgument = tuple[ArgumentDeclaration, list[Inclusion]]


def find_arguments(entities: Iterable[LaunchDescriptionEntity], conditional: bool) -> list[FoundArgument]:
    """Return the declared arguments, each with the inclusions through which it was found.

    Of arguments with the same name, the first counts.

    Args:
        entities: where the search begins; it goes on in what these yield.
        conditional: whether it is uncertain that the entities themselves are visited.
    """
    found: dict[str, FoundArgument] = {}

    def search(entities: Iterable[LaunchDescriptionEntity], conditional: bool, inclusions: list[Inclusion]) -> None:
        for entity in entities:
            if isinstance(entity, ArgumentScope):
                return
            if isinstance(entity, ArgumentDeclaration) and entity.name not in found:
                entity._conditionally_included = conditional or entity.condition is not None
                found[entity.name] = (entity, inclusions)
            inner = [*inclusions, entity] if isinstance(entity, Inclusion) else inclusions
            search(entity.describe_sub_entities(), conditional, inner)
            for _, possible in entity.describe_conditional_sub_entities():
                search(possible, True, inner)

    search(entities, conditional, [])
    return list(found.values())
