"""Typed values: plain values are used unchanged, the texts of substitutions are parsed by YAML's rules."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, get_args, get_origin

import yaml
from standin_notice import make_getattr

from ..launch_context import LaunchContext
from ..substitution import Substitution, normalize_to_list_of_substitutions, perform_substitutions

SCALARS = (bool, int, float, str)


def is_substitution(value: object) -> bool:
    """Return whether `value` is a substitution, or a sequence of strings and at least one substitution."""
    if isinstance(value, Substitution):
        return True
    if isinstance(value, (str, bytes)) or not isinstance(value, Iterable):
        return False
    items = list(value)
    return all(isinstance(item, (str, Substitution)) for item in items) and any(
        isinstance(item, Substitution) for item in items
    )


def _split_type(data_type: Any) -> tuple[type, bool]:
    """Return the scalar type of `data_type`, and whether it is a list; raise ValueError for other types."""
    is_list = get_origin(data_type) is list
    scalar = get_args(data_type)[0] if is_list else data_type
    if scalar not in SCALARS:
        raise ValueError(
            "data_type is invalid. Expected one of: int, float, str, bool, List[int], List[float], "
            f"List[str], List[bool]. Got {data_type}"
        )
    return scalar, is_list


def is_uniform_list(value: object) -> bool:
    """Return whether `value` is a list whose items are all Booleans, all integers, all floats or all strings."""
    if not isinstance(value, (list, tuple)):
        return False
    types = {type(item) for item in value}
    return not types or (len(types) == 1 and types <= set(SCALARS))


def coerce_to_type(text: str, data_type: Any = None) -> Any:
    """Return `text` converted to `data_type`, or by YAML's rules without one.

    Raises ValueError if it cannot be converted.
    """

    def parse_yaml() -> Any:
        try:
            return yaml.safe_load(text)
        except yaml.YAMLError as error:
            raise ValueError(f"Failed to convert '{text}' using yaml rules: {error}") from error

    if data_type is None:
        value = parse_yaml()
        if not isinstance(value, SCALARS) and not is_uniform_list(value):
            raise ValueError(
                f"Failed to convert '{text}' using yaml rules: output type is not allowed, got {type(value)}"
            )
        return value
    scalar, is_list = _split_type(data_type)
    if is_list:
        value = parse_yaml()
        if not isinstance(value, list) or not all(type(item) is scalar for item in value):
            raise ValueError(f"Cannot convert value '{text}' to a list of '{scalar}'")
        return value
    if scalar is str:
        return text
    if scalar is bool:
        value = {"1": True, "0": False}.get(text, parse_yaml())
        if not isinstance(value, bool):
            raise ValueError(f"Cannot convert value '{text}' to '{bool}'")
        return value
    return scalar(text)


def get_typed_value(value: str | list[str], data_type: Any, *, can_be_str: bool = False) -> Any:
    """Return a text, or each text of a list, converted to `data_type`, or by YAML's rules if that is None.

    Raises ValueError if it cannot be converted, unless it `can_be_str`, and TypeError for a list if `data_type` is a
    scalar type.
    """
    if isinstance(value, list):
        scalar, is_list = (None, True) if data_type is None else _split_type(data_type)
        if not is_list:
            raise TypeError(f"Cannot convert input '{value}' of type '{type(value)}' to '{data_type}'")
        return [get_typed_value(item, scalar, can_be_str=can_be_str) for item in value]
    try:
        return coerce_to_type(value, data_type)
    except ValueError:
        if can_be_str:
            return value
        raise


def is_instance_of(value: Any, data_type: Any, *, can_be_str: bool = False) -> bool:
    """Return whether `value` has the type `data_type`, or any type of a parameter if that is None."""
    if data_type is None:
        return isinstance(value, SCALARS) or (isinstance(value, list) and all(isinstance(x, SCALARS) for x in value))
    scalar, is_list = _split_type(data_type)
    allowed = (scalar, str) if can_be_str else scalar
    if is_list:
        return isinstance(value, list) and all(isinstance(item, allowed) for item in value)
    return isinstance(value, allowed)


def normalize_typed_substitution(value: Any, data_type: Any = None) -> Any:
    """Return plain values unchanged, and substitutions as lists of substitutions.

    Raises TypeError if a plain value does not have the type `data_type`.
    """
    if data_type is not None:
        scalar, is_list = _split_type(data_type)
    if isinstance(value, SCALARS):
        if data_type is not None and (is_list or not isinstance(value, scalar)):
            raise TypeError(f"value='{value}' is not an instance of {data_type}")
        return value
    if is_substitution(value):
        return normalize_to_list_of_substitutions(value)
    if not isinstance(value, Sequence):
        raise TypeError(
            "value should be either a scalar, a substitutions, or a mixed list of scalars and substitutions. "
            f"Got `value={value}` of type `{type(value)}`. "
        )
    if data_type is not None and not is_list:
        raise TypeError(f"value='{value}' is not an instance of {data_type}")
    return [normalize_typed_substitution(item, None if data_type is None else scalar) for item in value]


def perform_typed_substitution(context: LaunchContext, value: Any, data_type: Any = None) -> Any:
    """Return the value of a normalised `value` in `context`.

    Raises ValueError if the text of a substitution cannot be converted to `data_type`.
    """
    if isinstance(value, SCALARS):
        return value
    if value and all(isinstance(item, Substitution) for item in value):
        return coerce_to_type(perform_substitutions(context, value), data_type)
    scalar = None if data_type is None else _split_type(data_type)[0]
    items = [perform_typed_substitution(context, item, scalar) for item in value]
    if not is_uniform_list(items):
        raise ValueError(f"a list must hold items of one type, got {items}")
    return items


__getattr__ = make_getattr(__name__)
