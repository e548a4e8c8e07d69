"""The types of attributes in launch files."""

from __future__ import annotations

from typing import Any, get_args, get_origin

from .entity import Entity

_TYPES: dict[str, Any] = {
    "str": str,
    "bool": bool,
    "float": float,
    "int": int,
    "list_of_str": list[str],
    "list_of_bool": list[bool],
    "list_of_float": list[float],
    "list_of_int": list[int],
    "yaml": None,
}


def check_is_list_entity(data_type: Any) -> bool:
    """Return whether the type is a list of elements."""
    return get_origin(data_type) is list and issubclass(get_args(data_type)[0], Entity)


def get_data_type_from_identifier(type_identifier: str) -> Any:
    """Return the type of an identifier, None for ``yaml``; raise ValueError for an unknown one."""
    if type_identifier not in _TYPES:
        raise ValueError(f"Got invalid type identifier '{type_identifier}'")
    return _TYPES[type_identifier]
