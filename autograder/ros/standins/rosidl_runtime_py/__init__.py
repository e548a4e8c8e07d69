"""A stand-in for `rosidl_runtime_py`, which has no wheel: ROS messages to and from dictionaries, YAML and CSV.

It is imported only if the real package is not installed, by the same names. It covers `convert`, `set_message`,
`import_message`, `get_interfaces` and `utilities`. For the real package run `make real-launch`, or source an
installation of ROS 2 Jazzy.
"""

from standin_notice import make_getattr

from .convert import get_message_slot_types, message_to_csv, message_to_ordereddict, message_to_yaml
from .get_interfaces import (
    get_action_interfaces,
    get_all_interface_packages,
    get_interface_packages,
    get_interface_path,
    get_interfaces,
    get_message_interfaces,
    get_service_interfaces,
)
from .import_message import import_message_from_namespaced_type
from .set_message import set_message_fields

__all__ = [
    "get_action_interfaces",
    "get_all_interface_packages",
    "get_interface_packages",
    "get_interface_path",
    "get_interfaces",
    "get_message_interfaces",
    "get_message_slot_types",
    "get_service_interfaces",
    "import_message_from_namespaced_type",
    "message_to_csv",
    "message_to_ordereddict",
    "message_to_yaml",
    "set_message_fields",
]

__getattr__ = make_getattr(__name__)
