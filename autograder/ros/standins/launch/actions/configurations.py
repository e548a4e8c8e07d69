"""Actions that declare, set, save, restore and scope launch configurations."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from typing import Any

from .._arguments import ArgumentDeclaration, ArgumentScope
from ..action import Action
from ..launch_context import LaunchContext
from ..launch_description_entity import LaunchDescriptionEntity
from ..logging import get_logger
from ..substitution import (
    SomeSubstitutionsType,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from .environment import PopEnvironment, PushEnvironment, ResetEnvironment


class DeclareLaunchArgument(ArgumentDeclaration):
    """Declares an argument, whose value is the launch configuration of the same name.

    When the declaration is executed and no value is set, the default is performed.
    """

    def __init__(
        self,
        name: str,
        *,
        default_value: SomeSubstitutionsType | None = None,
        description: str | None = None,
        choices: Collection[str] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.name = name
        self.default_value = None if default_value is None else normalize_to_list_of_substitutions(default_value)
        self.choices = choices
        if self.choices is not None:
            if not self.choices:
                self._fail("Provided choices arg is empty. Use None to ignore the choice list.")
            if isinstance(default_value, str) and default_value not in self.choices:
                self._fail(f'Provided default_value "{default_value}" is not in provided choices "{self.choices}".')
        self.description = self._full_description(description)
        # Set while the arguments of a launch description are collected.
        self._conditionally_included = False

    def _full_description(self, description: str | None) -> str:
        if self.choices is None:
            return "no description given" if description is None else description
        if description is None:
            return f"One of: {self.choices}"
        return f"{description}{'' if description.endswith('.') else '.'} Valid choices are: {self.choices}"

    @staticmethod
    def _fail(message: str, *, logged: str | None = None) -> None:
        get_logger("launch.actions.declare_launch_argument").error(logged or message)
        raise RuntimeError(message)

    def execute(self, context: LaunchContext) -> None:
        """Set the default if no value is set; raise RuntimeError for a missing or an invalid value."""
        if self.name not in context.launch_configurations:
            if self.default_value is None:
                self._fail(
                    f'Required launch argument "{self.name}" was not provided.',
                    logged=f'Required launch argument "{self.name}" (description: "{self.description}") '
                    "was not provided",
                )
            else:
                context.launch_configurations[self.name] = perform_substitutions(context, self.default_value)
        value = context.launch_configurations[self.name]
        if self.choices is not None and value not in self.choices:
            self._fail(
                f'Argument "{self.name}" provided value "{value}" is not valid. Valid options are: {self.choices}'
            )


class SetLaunchConfiguration(Action):
    """Sets a launch configuration."""

    def __init__(self, name: SomeSubstitutionsType, value: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name = normalize_to_list_of_substitutions(name)
        self.value = normalize_to_list_of_substitutions(value)

    def execute(self, context: LaunchContext) -> None:
        """Set the launch configuration."""
        name = perform_substitutions(context, self.name)
        context.launch_configurations[name] = perform_substitutions(context, self.value)


class UnsetLaunchConfiguration(Action):
    """Removes a launch configuration, if it exists."""

    def __init__(self, name: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name = normalize_to_list_of_substitutions(name)

    def execute(self, context: LaunchContext) -> None:
        """Remove the launch configuration."""
        context.launch_configurations.pop(perform_substitutions(context, self.name), None)


class PushLaunchConfigurations(Action):
    """Saves the launch configurations."""

    def execute(self, context: LaunchContext) -> None:
        """Save the launch configurations."""
        context._push_launch_configurations()


class PopLaunchConfigurations(Action):
    """Restores the launch configurations that were saved last."""

    def execute(self, context: LaunchContext) -> None:
        """Restore the launch configurations."""
        context._pop_launch_configurations()


class ResetLaunchConfigurations(ArgumentScope):
    """Removes all launch configurations except the given ones, whose values are performed first."""

    def __init__(
        self,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self._kept_configurations = [
            (normalize_to_list_of_substitutions(name), normalize_to_list_of_substitutions(value))
            for name, value in (launch_configurations or {}).items()
        ]

    def execute(self, context: LaunchContext) -> None:
        """Remove the other launch configurations."""
        kept_configurations: dict[str, str] = {
            perform_substitutions(context, name): perform_substitutions(context, value)
            for name, value in self._kept_configurations
        }
        context.launch_configurations.clear()
        context.launch_configurations.update(kept_configurations)


class GroupAction(Action):
    """Executes actions together, by default in their own scope.

    At the end of the scope, launch configurations and environment are restored. Without `forwarding`, the scope starts
    with the environment from before the launch, and with no configurations except the given `launch_configurations`.
    """

    def __init__(
        self,
        actions: Iterable[LaunchDescriptionEntity],
        *,
        scoped: bool = True,
        forwarding: bool = True,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        configurations = launch_configurations or {}
        set_actions = [SetLaunchConfiguration(name, value) for name, value in configurations.items()]
        entities: list[LaunchDescriptionEntity] = [*set_actions, *actions]
        if scoped and forwarding:
            entities = [PushLaunchConfigurations(), PushEnvironment(), *entities]
        elif scoped:
            entities = [
                PushLaunchConfigurations(),
                PushEnvironment(),
                ResetEnvironment(),
                ResetLaunchConfigurations(configurations),
                *entities[len(set_actions) :],
            ]
        if scoped:
            entities += [PopEnvironment(), PopLaunchConfigurations()]
        self._entities = entities

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the actions, with the actions that create and end their scope."""
        return self._entities

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Return the actions, which are executed next."""
        return self._entities
