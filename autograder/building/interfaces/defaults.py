"""The initial values of fields."""

from __future__ import annotations

import array
import copy
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from rosidl_parser import definition as rosidl

from autograder.building.interfaces.cdr import CODES, NUMBERS


def of(kind: rosidl.AbstractType, given: Any, make: Callable[[rosidl.NamespacedType], Any]) -> Callable[[], Any]:
    """Return a function that returns the default of a field, each time a new object.

    Args:
        kind: the field's type.
        given: the default of its definition, None where it has none.
        make: makes a message of a type.
    """
    if not isinstance(kind, rosidl.AbstractNestedType):
        return _single(kind, given, make)
    value = kind.value_type
    count = kind.size if isinstance(kind, rosidl.Array) else 0
    singles = [_single(value, each, make) for each in ([None] * count if given is None else given)]
    if not isinstance(value, rosidl.BasicType) or value.typename not in NUMBERS:
        return lambda: [single() for single in singles]
    code = CODES[value.typename]
    numbers = [single() for single in singles]
    filled: Any = (
        np.array(numbers, np.dtype(code).str) if isinstance(kind, rosidl.Array) else array.array(code, numbers)
    )
    return partial(copy.copy, filled)


def _single(kind: Any, given: Any, make: Callable[[rosidl.NamespacedType], Any]) -> Callable[[], Any]:
    if isinstance(kind, rosidl.NamespacedType):
        return partial(make, kind)
    if isinstance(kind, rosidl.AbstractGenericString):
        return lambda: given or ""
    if kind.typename == "octet":
        return lambda: bytes([given or 0])
    plain = {"boolean": bool, "float": float, "double": float}.get(kind.typename, int)
    return lambda: plain(given or 0)
