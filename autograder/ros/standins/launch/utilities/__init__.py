"""Helpers for launch files and packages that define their own actions and substitutions."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from standin_notice import make_getattr

from ..substitution import normalize_to_list_of_substitutions, perform_substitutions

__all__ = [
    "ensure_argument_type",
    "is_a",
    "is_a_subclass",
    "normalize_to_list_of_substitutions",
    "perform_substitutions",
]


def is_a(entity: object, entity_type: type) -> bool:
    """Return whether `entity` is an instance of `entity_type`."""
    return isinstance(entity, entity_type)


def is_a_subclass(entity: object, entity_type: type) -> bool:
    """Return whether `entity` is an instance or a subclass of `entity_type`."""
    return isinstance(entity, entity_type) or (isinstance(entity, type) and issubclass(entity, entity_type))


def ensure_argument_type(
    argument: object, types: type | Iterable[type], argument_name: str, caller: str | None = None
) -> None:
    """Raise TypeError unless `argument` has one of `types`."""
    expected_types = (types,) if isinstance(types, type) else tuple(types)
    if not isinstance(argument, expected_types):
        suffix = f" of '{caller}'" if caller else ""
        names: list[Any] = [cls.__name__ for cls in expected_types]
        raise TypeError(
            f"Expected '{argument_name}'{suffix} to be one of {names}, but got '{argument}' of type '{type(argument)}'"
        )


__getattr__ = make_getattr(__name__)
