"""Substitutions: text that is only known when the launch description is executed."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from .launch_context import LaunchContext


class Substitution:
    """A text that depends on the launch context."""

    @classmethod
    def parse(cls, data: Sequence[Any]) -> tuple[type[Substitution], dict[str, Any]]:
        """Return the class and its keyword arguments, from the arguments of a substitution such as ``$(env HOME)``."""
        return cls, {}

    def describe(self) -> str:
        """Return a description of the substitution, for use before its value is known."""
        return self.__repr__()

    def perform(self, context: LaunchContext) -> str:
        """Return the text of this substitution in `context`."""
        return ""


SomeSubstitutionsType = str | Substitution | Iterable[str | Substitution]
SomeSubstitutionsType_types_tuple = (str, Substitution, Iterable)


class TextSubstitution(Substitution):
    """A fixed piece of text."""

    def __init__(self, *, text: str) -> None:
        if not isinstance(text, str):
            raise TypeError(f"TextSubstitution expected Text object got '{type(text)}' instead.")
        self.text = text

    def describe(self) -> str:
        """Return the text in quotes."""
        return f"'{self.text}'"

    def perform(self, context: LaunchContext) -> str:
        """Return the text."""
        return self.text


def normalize_to_list_of_substitutions(subs: SomeSubstitutionsType) -> list[Substitution]:
    """Return `subs`, which may be one string, one substitution or several of them, as a list.

    Raises TypeError for any other type.
    """

    def normalize(item: object) -> Substitution:
        if isinstance(item, str):
            return TextSubstitution(text=item)
        if isinstance(item, Substitution):
            return item
        raise TypeError(
            f"Failed to normalize given item of type '{type(item)}', when only 'str' or "
            "'launch.Substitution' were expected."
        )

    if isinstance(subs, (str, Substitution)) or not isinstance(subs, Iterable):
        return [normalize(subs)]
    return [normalize(item) for item in subs]


def perform_substitutions(context: LaunchContext, subs: Iterable[Substitution]) -> str:
    """Return the joined texts of `subs`."""
    return "".join(context.perform_substitution(sub) for sub in subs)


def describe_substitutions(subs: SomeSubstitutionsType) -> str:
    """Return a description of `subs`, for use before their values are known."""
    return " + ".join(sub.describe() for sub in normalize_to_list_of_substitutions(subs))
