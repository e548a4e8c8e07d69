"""Logical substitutions: not, and, or, any, all and comparisons, with the text ``true`` or ``false``, and a choice."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from ..exceptions import SubstitutionFailure
from ..launch_context import LaunchContext
from ..substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from ..utilities.type_utils import perform_typed_substitution


def _truth(context: LaunchContext, value: list[Substitution]) -> bool:
    try:
        return bool(perform_typed_substitution(context, value, bool))
    except (TypeError, ValueError) as error:
        raise SubstitutionFailure(str(error)) from error


def _text(value: bool) -> str:
    return "true" if value else "false"


class NotSubstitution(Substitution):
    """True if the value is false."""

    def __init__(self, value: SomeSubstitutionsType) -> None:
        self.value = normalize_to_list_of_substitutions(value)

    def describe(self) -> str:
        """Return a description with the value."""
        return f"NotSubstitution({describe_substitutions(self.value)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the opposite Boolean."""
        return _text(not _truth(context, self.value))


class _Logical(Substitution):
    """The base of substitutions that combine several Booleans."""

    def __init__(self, *args: SomeSubstitutionsType) -> None:
        self.args = [normalize_to_list_of_substitutions(arg) for arg in args]

    def describe(self) -> str:
        """Return a description with the values."""
        return f"{type(self).__name__}({' '.join(describe_substitutions(arg) for arg in self.args)})"


class AnySubstitution(_Logical):
    """True if at least one value is true."""

    def perform(self, context: LaunchContext) -> str:
        """Return whether one of the values is true; all of them are performed."""
        return _text(any([_truth(context, arg) for arg in self.args]))


class AllSubstitution(_Logical):
    """True if all values are true."""

    def perform(self, context: LaunchContext) -> str:
        """Return whether all of the values are true; all of them are performed."""
        return _text(all([_truth(context, arg) for arg in self.args]))


class AndSubstitution(AllSubstitution):
    """True if both values are true."""

    def __init__(self, left: SomeSubstitutionsType, right: SomeSubstitutionsType) -> None:
        super().__init__(left, right)
        self.left, self.right = self.args


class OrSubstitution(AnySubstitution):
    """True if at least one of two values is true."""

    def __init__(self, left: SomeSubstitutionsType, right: SomeSubstitutionsType) -> None:
        super().__init__(left, right)
        self.left, self.right = self.args


def _comparable(value: Any) -> list[Substitution]:
    """Return one side of a comparison as substitutions, with plain values of any type as text."""
    if value is None:
        return normalize_to_list_of_substitutions("")
    if isinstance(value, bool):
        return normalize_to_list_of_substitutions(_text(value))
    if isinstance(value, (str, Substitution)):
        return normalize_to_list_of_substitutions(value)
    if isinstance(value, Iterable):
        items = list(value)
        if any(isinstance(item, Substitution) for item in items):
            return normalize_to_list_of_substitutions(items)
        return normalize_to_list_of_substitutions(str(value))
    return normalize_to_list_of_substitutions(str(value))


def _are_equal(left: str, right: str) -> bool:
    """Return whether two texts are equal: as Booleans, as numbers, or otherwise character by character."""
    booleans = {"true": True, "1": True, "false": False, "0": False}
    if left.lower() in booleans and right.lower() in booleans:
        return booleans[left.lower()] == booleans[right.lower()]
    try:
        return math.isclose(float(left), float(right))
    except ValueError:
        return left == right


class EqualsSubstitution(Substitution):
    """True if both sides are equal."""

    def __init__(self, left: Any, right: Any) -> None:
        self.left = _comparable(left)
        self.right = _comparable(right)

    def describe(self) -> str:
        """Return a description with both sides."""
        return f"{type(self).__name__}({describe_substitutions(self.left)} {describe_substitutions(self.right)})"

    def _sides_are_equal(self, context: LaunchContext) -> bool:
        return _are_equal(perform_substitutions(context, self.left), perform_substitutions(context, self.right))

    def perform(self, context: LaunchContext) -> str:
        """Return whether both sides are equal."""
        return _text(self._sides_are_equal(context))


class NotEqualsSubstitution(EqualsSubstitution):
    """True if both sides differ."""

    def perform(self, context: LaunchContext) -> str:
        """Return whether both sides differ."""
        return _text(not self._sides_are_equal(context))


class IfElseSubstitution(Substitution):
    """One of two values, depending on a condition."""

    def __init__(
        self,
        condition: SomeSubstitutionsType,
        if_value: SomeSubstitutionsType = "",
        else_value: SomeSubstitutionsType = "",
    ) -> None:
        if if_value == else_value == "":
            raise RuntimeError("One of if_value and else_value must be specified")
        self.condition = normalize_to_list_of_substitutions(condition)
        self.if_value = normalize_to_list_of_substitutions(if_value)
        self.else_value = normalize_to_list_of_substitutions(else_value)

    def describe(self) -> str:
        """Return a description with condition and values."""
        parts = (self.condition, self.if_value, self.else_value)
        return f"IfElseSubstitution({', '.join(describe_substitutions(part) for part in parts)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the value that the condition selects; the other one is not performed."""
        value = self.if_value if _truth(context, self.condition) else self.else_value
        return perform_substitutions(context, value)
