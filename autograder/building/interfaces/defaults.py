"""Provides functions that create the initial values of fields."""

from __future__ import annotations

import array
import copy
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from rosidl_parser import definition as rosidl

from autograder.building.interfaces.cdr import CODES, NUMBERS


def default_factory(
    kind: rosidl.AbstractType, default: Any, make: Callable[[rosidl.NamespacedType], Any]
) -> Callable[[], Any]:
    """Return a function that creates the initial value of a field, a new object at each call.

    Args:
        kind: the field's type.
        default: the default in its definition, or None.
        make: creates a message of a type.
    """
    if not isinstance(kind, rosidl.AbstractNestedType):
        return _single_factory(kind, default, make)
    value = kind.value_type
    count = kind.size if isinstance(kind, rosidl.Array) else 0
    factories = [_single_factory(value, item, make) for item in ([None] * count if default is None else default)]
    if not isinstance(value, rosidl.BasicType) or value.typename not in NUMBERS:
        return lambda: [factory() for factory in factories]
    code = CODES[value.typename]
    numbers = [factory() for factory in factories]
    values: Any = (
        np.array(numbers, np.dtype(code).str) if isinstance(kind, rosidl.Array) else array.array(code, numbers)
    )
    return partial(copy.copy, values)


def _single_factory(kind: Any, default: Any, make: Callable[[rosidl.NamespacedType], Any]) -> Callable[[], Any]:
    if isinstance(kind, rosidl.NamespacedType):
        return partial(make, kind)
    if isinstance(kind, rosidl.AbstractGenericString):
        return lambda: default or ""
    if kind.typename == "octet":
        return lambda: bytes([default or 0])
    convert = {"boolean": bool, "float": float, "double": float}.get(kind.typename, int)
    return lambda: convert(default or 0)
