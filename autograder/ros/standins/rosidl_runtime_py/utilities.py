"""Import of an interface's Python class by its name (stand-in for `rosidl_runtime_py.utilities`)."""

from __future__ import annotations

import importlib
from typing import Any

from rosidl_parser.definition import NamespacedType
from standin_notice import make_getattr


def get_interface(identifier: str) -> Any:
    """Import the class of a message, service or action named `package/kind/Name`.

    Raises:
        ValueError: the name does not have three parts.
        ModuleNotFoundError: there is no such package, or it has no interface of this kind.
        AttributeError: the package has no interface of this name.
    """
    package, kind, name = _split(identifier, None)
    return _load(package, kind, name)


def get_message(identifier: str) -> Any:
    """Import the class of a message named `package/msg/Name` or `package/Name`; errors as in `get_interface`."""
    return _load(*_split(identifier, "msg"))


def get_service(identifier: str) -> Any:
    """Import the class of a service named `package/srv/Name` or `package/Name`; errors as in `get_interface`."""
    return _load(*_split(identifier, "srv"))


def get_action(identifier: str) -> Any:
    """Import the class of an action named `package/action/Name` or `package/Name`; errors as in `get_interface`."""
    return _load(*_split(identifier, "action"))


def get_message_namespaced_type(identifier: str) -> NamespacedType:
    """Return the parsed type of a message named `package/msg/Name` or `package/Name`."""
    package, kind, name = _split(identifier, "msg")
    return NamespacedType([package, kind], name)


def _split(identifier: str, kind: str | None) -> tuple[str, str, str]:
    """Split a name into three parts; `kind` is inserted into a name of two parts."""
    parts = identifier.split("/")
    if kind is not None and len(parts) == 2:
        parts.insert(1, kind)
    if len(parts) != 3 or not all(parts) or (kind is not None and parts[1] != kind):
        expected = f"package/{kind}/Name" if kind else "package/kind/Name"
        raise ValueError(f"'{identifier}' is not a full interface name, such as {expected}")
    return parts[0], parts[1], parts[2]


def _load(package: str, kind: str, name: str) -> Any:
    return getattr(importlib.import_module(f"{package}.{kind}"), name)


__getattr__ = make_getattr(__name__)
