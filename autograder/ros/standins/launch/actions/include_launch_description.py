"""The action that executes another launch file."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from .._arguments import Inclusion
from ..launch_context import LaunchContext
from ..launch_description import LaunchDescription
from ..launch_description_entity import LaunchDescriptionEntity
from ..launch_description_source import LaunchDescriptionSource
from ..launch_description_sources import AnyLaunchDescriptionSource
from ..substitution import (
    SomeSubstitutionsType,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from .configurations import SetLaunchConfiguration
from .opaque_function import OpaqueFunction

Argument = tuple[SomeSubstitutionsType, SomeSubstitutionsType]
_LOCALS = ("current_launch_file_path", "current_launch_file_directory")


class IncludeLaunchDescription(Inclusion):
    """Executes another launch description, with arguments as pairs of name and value.

    The arguments become launch configurations, which stay set afterwards, unless a group contains the include.
    """

    def __init__(
        self,
        launch_description_source: LaunchDescriptionSource | SomeSubstitutionsType,
        *,
        launch_arguments: Iterable[Argument] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        if not isinstance(launch_description_source, LaunchDescriptionSource):
            launch_description_source = AnyLaunchDescriptionSource(launch_description_source)
        self.launch_description_source = launch_description_source
        self.launch_arguments = [self._pair(argument) for argument in launch_arguments or ()]

    @staticmethod
    def _pair(argument: Any) -> Argument:
        if isinstance(argument, str) or not isinstance(argument, (tuple, list)) or len(argument) != 2:
            raise ValueError(
                f"launch_arguments must be pairs of name and value, got {argument!r}; give the items() of a dictionary"
            )
        return argument[0], argument[1]

    def describe(self) -> str:
        """Return a description with the location of the included description."""
        return f"IncludeLaunchDescription({self.launch_description_source.location})"

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the included description, if it can be loaded without a context."""
        description = self.launch_description_source.try_get_launch_description_without_context()
        return [] if description is None else [description]

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Return the included description, with its arguments set before it.

        Raises RuntimeError if it declares an argument that has neither a value nor a default.
        """
        previous_locals = {key: value for key, value in context.get_locals_as_dict().items() if key in _LOCALS}
        description = self.launch_description_source.get_launch_description(context)
        self._set_location(context)
        self._check_arguments(context, description)

        def restore(context: LaunchContext) -> None:
            for key in _LOCALS:
                context.get_locals_as_dict().pop(key, None)
            context.extend_locals(previous_locals)

        set_actions = [SetLaunchConfiguration(name, value) for name, value in self.launch_arguments]
        return [*set_actions, description, OpaqueFunction(function=restore)]

    def _set_location(self, context: LaunchContext) -> None:
        location = self.launch_description_source.location
        path = Path(location)
        exists = path.exists()
        context.extend_locals(
            {
                "current_launch_file_path": str(path.absolute()) if exists else location,
                "current_launch_file_directory": str(path.absolute().parent) if exists else location,
            }
        )

    def _check_arguments(self, context: LaunchContext, description: LaunchDescription) -> None:
        given_names = [
            perform_substitutions(context, normalize_to_list_of_substitutions(name))
            for name, _ in self.launch_arguments
        ]
        for argument, includes in description.get_launch_arguments_with_include_launch_description_actions():
            if argument._conditionally_included or argument.default_value is not None:
                continue
            included_names = [name for include in includes for name in include._plain_argument_names()]
            if argument.name not in [*given_names, *included_names]:
                raise RuntimeError(
                    f"Included launch description missing required argument '{argument.name}' "
                    f"(description: '{argument.description}'), given: [{', '.join(given_names)}]"
                )

    def _plain_argument_names(self) -> list[str]:
        """Return the names of the arguments that are plain text."""
        return [name for name, _ in self.launch_arguments if isinstance(name, str)]
