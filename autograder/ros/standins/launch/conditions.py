"""Conditions on substitutions and launch configurations."""

from __future__ import annotations

import warnings
from collections.abc import Iterable

from standin_notice import make_getattr

from .condition import Condition
from .exceptions import InvalidConditionExpressionError
from .launch_context import LaunchContext
from .substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

__all__ = [
    "IfCondition",
    "InvalidConditionExpressionError",
    "LaunchConfigurationEquals",
    "LaunchConfigurationNotEquals",
    "UnlessCondition",
    "evaluate_condition_expression",
]

_TRUE = ("true", "1")
_FALSE = ("false", "0")


def evaluate_condition_expression(context: LaunchContext, expression: Iterable[Substitution]) -> bool:
    """Return whether the text of `expression` is true or 1 (True), or false or 0 (False).

    Raises InvalidConditionExpressionError for any other text.
    """
    text = perform_substitutions(context, expression).strip().lower()
    if text not in _TRUE + _FALSE:
        raise InvalidConditionExpressionError(
            f"invalid condition expression, expected one of [{', '.join(_TRUE + _FALSE)}] but got '{text}', "
            f"expanded from '{', '.join(map(str, expression))}'"
        )
    return text in _TRUE


class IfCondition(Condition):
    """True if the expression is true or 1, False if it is false or 0."""

    def __init__(self, predicate_expression: SomeSubstitutionsType) -> None:
        self._expression = normalize_to_list_of_substitutions(predicate_expression)
        super().__init__(predicate=lambda context: evaluate_condition_expression(context, self._expression))


class UnlessCondition(Condition):
    """The opposite of IfCondition."""

    def __init__(self, predicate_expression: SomeSubstitutionsType) -> None:
        self._expression = normalize_to_list_of_substitutions(predicate_expression)
        super().__init__(predicate=lambda context: not evaluate_condition_expression(context, self._expression))


def _configuration_equals(context: LaunchContext, name: str, expected: list[Substitution] | None) -> bool:
    value = context.launch_configurations.get(name)
    if expected is None or value is None:
        return expected is None and value is None
    return bool(value == perform_substitutions(context, expected))


def _warn_of_deprecation(condition: Condition) -> None:
    text = f"{type(condition).__name__} is deprecated: use IfCondition with EqualsSubstitution or NotEqualsSubstitution"
    warnings.warn(text, UserWarning, stacklevel=3)


class LaunchConfigurationEquals(Condition):
    """True if a launch configuration has the given text, or is not set and None is expected."""

    def __init__(self, launch_configuration_name: str, expected_value: SomeSubstitutionsType | None) -> None:
        _warn_of_deprecation(self)
        expected = None if expected_value is None else normalize_to_list_of_substitutions(expected_value)
        super().__init__(predicate=lambda context: _configuration_equals(context, launch_configuration_name, expected))


class LaunchConfigurationNotEquals(Condition):
    """The opposite of LaunchConfigurationEquals."""

    def __init__(self, launch_configuration_name: str, expected_value: SomeSubstitutionsType | None) -> None:
        _warn_of_deprecation(self)
        expected = None if expected_value is None else normalize_to_list_of_substitutions(expected_value)
        super().__init__(
            predicate=lambda context: not _configuration_equals(context, launch_configuration_name, expected)
        )


__getattr__ = make_getattr(__name__)
