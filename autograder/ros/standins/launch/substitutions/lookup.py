"""Substitutions that look up a value: in configurations, the environment, local values, or the launch file."""

from __future__ import annotations

import ast
import os
import re
from collections.abc import Iterable
from typing import Any, cast

from ..exceptions import SubstitutionFailure
from ..launch_context import LaunchContext
from ..logging import launch_config
from ..substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from .paths import DirectorySubstitution


def _normalize_default(value: Any) -> list[Substitution] | None:
    """Return a default of any type as substitutions; numbers and Booleans become text."""
    if value is None:
        return None
    items = [value] if isinstance(value, (str, Substitution)) or not isinstance(value, Iterable) else value
    return normalize_to_list_of_substitutions([item if isinstance(item, Substitution) else str(item) for item in items])


class LaunchConfiguration(Substitution):
    """The value of a launch configuration, for example of a declared argument."""

    def __init__(self, variable_name: SomeSubstitutionsType, *, default: Any = None) -> None:
        self.variable_name = normalize_to_list_of_substitutions(variable_name)
        self._default = _normalize_default(default)

    def describe(self) -> str:
        """Return a description with the name."""
        return f"LaunchConfig({describe_substitutions(self.variable_name)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the value, or the default; raise SubstitutionFailure without either."""
        name = perform_substitutions(context, self.variable_name)
        if name in context.launch_configurations:
            return str(context.launch_configurations[name])
        if self._default is None:
            raise SubstitutionFailure(f"launch configuration '{name}' does not exist")
        return perform_substitutions(context, self._default)


class EnvironmentVariable(Substitution):
    """The value of an environment variable."""

    def __init__(self, name: SomeSubstitutionsType, *, default_value: SomeSubstitutionsType | None = None) -> None:
        self.name = normalize_to_list_of_substitutions(name)
        self.default_value = _normalize_default(default_value)

    def describe(self) -> str:
        """Return a description with the name."""
        return f"EnvVar({describe_substitutions(self.name)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the value, or the default; raise SubstitutionFailure without either."""
        name = perform_substitutions(context, self.name)
        if name in context.environment:
            return context.environment[name]
        if self.default_value is None:
            raise SubstitutionFailure(f"environment variable '{name}' does not exist")
        return perform_substitutions(context, self.default_value)


class LocalSubstitution(Substitution):
    """A local value, by a path of attributes and keys such as ``event.returncode``."""

    _STEP = re.compile(r"\.?(?P<name>[A-Za-z_]\w*)|\[(?P<key>[^\]]+)\]")

    def __init__(self, expression: str, *, description: str | None = None) -> None:
        self.expression = expression
        self.description = description

    def describe(self) -> str:
        """Return a description with the path."""
        return f"LocalVar('{self.description or self.expression}')"

    def perform(self, context: LaunchContext) -> str:
        """Return the value, which need not be a text; raise SubstitutionFailure if the path does not exist."""
        value: Any = context.locals
        position = 0
        while position < len(self.expression):
            step = self._STEP.match(self.expression, position)
            if step is None:
                raise SubstitutionFailure(f"local expression '{self.expression}' is not a path")
            try:
                key = step["key"]
                value = getattr(value, step["name"]) if key is None else value[ast.literal_eval(key)]
            except (AttributeError, LookupError, TypeError, ValueError) as error:
                raise SubstitutionFailure(
                    f"local expression '{self.expression}' cannot be resolved: {error}"
                ) from error
            position = step.end()
        return cast(str, value)


class _LaunchFileLocal(Substitution):
    """The base of substitutions with a local value of the launch file that is being executed."""

    local = ""

    def describe(self) -> str:
        """Return the name of the substitution."""
        return f"{type(self).__name__}()"

    def perform(self, context: LaunchContext) -> str:
        """Return the path; raise SubstitutionFailure outside of a launch file."""
        try:
            return str(context.get_locals_as_dict()[self.local])
        except KeyError:
            raise SubstitutionFailure(f"{type(self).__name__} used outside of a launch file (in a script)") from None


class ThisLaunchFile(_LaunchFileLocal):
    """The path of the launch file that is being executed."""

    local = "current_launch_file_path"


class ThisLaunchFileDir(_LaunchFileLocal, DirectorySubstitution):
    """The folder of the launch file that is being executed."""

    local = "current_launch_file_directory"


class LaunchLogDir(DirectorySubstitution):
    """The folder of this launch's log files."""

    def describe(self) -> str:
        """Return the name of the substitution."""
        return "LaunchLogDir()"

    def perform(self, context: LaunchContext) -> str:
        """Return the folder."""
        return launch_config.log_dir


class AnonName(Substitution):
    """A unique name, which stays the same during one launch."""

    def __init__(self, name: SomeSubstitutionsType) -> None:
        self.name = normalize_to_list_of_substitutions(name)

    def describe(self) -> str:
        """Return a description with the name."""
        return f"AnonName({describe_substitutions(self.name)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the name with the host, the process id and a random number."""
        name = perform_substitutions(context, self.name)
        key = f"anon{name}"
        if key not in context.launch_configurations:
            suffix = f"{os.uname().nodename}_{os.getpid()}_{int.from_bytes(os.urandom(4), 'little')}"
            context.launch_configurations[key] = re.sub(r"\W", "_", f"{name}_{suffix}")
        return str(context.launch_configurations[key])
