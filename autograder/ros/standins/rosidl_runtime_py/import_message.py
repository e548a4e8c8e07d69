"""Import of the Python class of a parsed type (stand-in for `rosidl_runtime_py.import_message`)."""

from __future__ import annotations

import importlib
from typing import Any


def import_message_from_namespaced_type(message_type: Any) -> Any:
    """Import the class that a `rosidl_parser.definition.NamespacedType` names."""
    module = importlib.import_module(".".join(message_type.namespaces))
    return getattr(module, message_type.name)
