"""Substitutions that join the parts of a path."""

from __future__ import annotations

import os
from collections.abc import Iterable

from ..launch_context import LaunchContext
from ..substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class DirectorySubstitution(Substitution):
    """The path of a folder. The operator ``/`` appends a component, as in Jazzy since launch 3.4.5."""

    def __truediv__(self, component: SomeSubstitutionsType) -> Substitution:
        """Return the path of `component` in this folder; a component may have several parts."""
        return PathJoinSubstitution([self, component])


class PathJoinSubstitution(DirectorySubstitution):
    """A path made of components; each is a text, a substitution, or a list of both."""

    def __init__(self, substitutions: SomeSubstitutionsType | Iterable[SomeSubstitutionsType]) -> None:
        if isinstance(substitutions, (str, Substitution)):
            substitutions = [substitutions]
        self.substitutions = [normalize_to_list_of_substitutions(component) for component in substitutions]

    def describe(self) -> str:
        """Return a description with the components."""
        return f"PathJoin({', '.join(map(describe_substitutions, self.substitutions))})"

    def perform(self, context: LaunchContext) -> str:
        """Return the joined path."""
        parts = [perform_substitutions(context, component) for component in self.substitutions]
        return os.path.join(*parts)  # noqa: PTH118  # a Path would drop trailing slashes and dots


class PathSubstitution(PathJoinSubstitution):
    """A path of one component, to which ``/`` appends others."""

    def __init__(self, path: SomeSubstitutionsType) -> None:
        super().__init__([path])
