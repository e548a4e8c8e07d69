"""Sources of launch descriptions: an object, or a file."""

from __future__ import annotations

from collections.abc import Callable

from .launch_context import LaunchContext
from .launch_description import LaunchDescription
from .substitution import (
    SomeSubstitutionsType,
    TextSubstitution,
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class LaunchDescriptionSource:
    """A launch description, or a location from which `load` reads it when it is needed."""

    def __init__(
        self,
        launch_description: LaunchDescription | None = None,
        location: SomeSubstitutionsType = "",
        method: str = "unspecified mechanism from a script",
        *,
        load: Callable[[str], LaunchDescription] | None = None,
    ) -> None:
        self._description = launch_description
        self._location = normalize_to_list_of_substitutions(location)
        self._expanded_location: str | None = None
        self.method = method
        self._load = load

    @property
    def location(self) -> str:
        """The location as text, or a description of it before it is known."""
        if self._expanded_location is None:
            return describe_substitutions(self._location)
        return self._expanded_location

    def get_launch_description(self, context: LaunchContext) -> LaunchDescription:
        """Return the launch description; errors of `load` are not caught."""
        if self._expanded_location is None:
            self._expanded_location = perform_substitutions(context, self._location)
        if self._description is None:
            if self._load is None:
                raise RuntimeError(f"there is no launch description at {self.location}")
            self._description = self._load(self._expanded_location)
        return self._description

    def try_get_launch_description_without_context(self) -> LaunchDescription | None:
        """Return the launch description if its location is plain text, else None."""
        if self._description is None and self._load is not None:
            parts = [part for part in self._location if isinstance(part, TextSubstitution)]
            if len(parts) == len(self._location):
                self._expanded_location = "".join(part.text for part in parts)
                self._description = self._load(self._expanded_location)
        return self._description
