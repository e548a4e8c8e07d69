"""Creates type supports without generated code. They transport a message as bytes, so that no type needs a library.

For rclpy and rmw_fastrtps_cpp, a type consists of C structures with its name, its hash and functions that convert its
messages. rosidl generates these as code. Here they are created at run time, for any name, and the functions only copy
bytes, which `messages` interprets. Instead of a C pointer to a message, the functions get the number of an entry in
`_messages`.

rmw_fastrtps_cpp passes the bytes in a `Cdr` of Fast CDR 2, in which the end of the bytes is a private member. This
module reads it from memory. To verify the layout, it compares other members with what public functions return.
"""

from __future__ import annotations

import ctypes
import itertools
from collections.abc import Callable, Mapping
from ctypes import POINTER, Structure, c_bool, c_char, c_char_p, c_size_t, c_uint8, c_uint32, c_void_p, cast
from dataclasses import dataclass
from functools import cache
from typing import Any

from autograder.building.interfaces.cdr import MAX_BYTES
from autograder.building.interfaces.introspection import IDENTIFIER, MessageSupport
from autograder.exceptions import GraderError

LITTLE_ENDIAN = b"\x00\x01"  # the first bytes of a CDR header
POSITIONS_OFFSET = 18 * 8  # bytes of a `Cdr` before its positions in the buffer
HEADER_SIZE = 4  # bytes of a CDR header
INITIAL_SIZE = 256  # bytes that a history allocates for a message in advance; it allocates more if needed
# The attributes that rclpy needs in the metaclass of a message class.
NAMES = ("_CREATE_ROS_MESSAGE", "_CONVERT_FROM_PY", "_CONVERT_TO_PY", "_DESTROY_ROS_MESSAGE", "_TYPE_SUPPORT")

_kept_alive: list[Any] = []  # objects that C code refers to until the process ends
_messages: dict[int, bytes | None] = {}  # the bytes of each message; None if they could not be read
_numbers = itertools.count(1)

_Serialize = ctypes.CFUNCTYPE(c_bool, c_void_p, c_void_p)
_Size = ctypes.CFUNCTYPE(c_uint32, c_void_p)
_MaximumSize = ctypes.CFUNCTYPE(c_size_t, POINTER(c_char))
_Get = ctypes.CFUNCTYPE(c_void_p, c_void_p)
_Handle = ctypes.CFUNCTYPE(c_void_p, c_void_p, c_char_p)
_Create = ctypes.PYFUNCTYPE(c_void_p)
_FromPython = ctypes.PYFUNCTYPE(c_bool, ctypes.py_object, c_void_p)
_ToPython = ctypes.PYFUNCTYPE(ctypes.py_object, c_void_p)
_Destroy = ctypes.PYFUNCTYPE(None, c_void_p)


class _MessageCallbacks(Structure):  # message_type_support_callbacks_t
    _fields_ = (
        *(("namespace", c_char_p), ("name", c_char_p), ("serialize", _Serialize), ("deserialize", _Serialize)),
        *(("size", _Size), ("maximum_size", _MaximumSize), ("key_callbacks", c_void_p)),
    )


class _ServiceCallbacks(Structure):  # service_type_support_callbacks_t
    _fields_ = (("namespace", c_char_p), ("name", c_char_p), ("request", c_void_p), ("response", c_void_p))


class _Service(Structure):  # rosidl_service_type_support_t
    _fields_ = (
        *(("identifier", c_void_p), ("data", c_void_p), ("handle", c_void_p)),
        *(("request", c_void_p), ("response", c_void_p), ("event", c_void_p)),
        *(("create_event", c_void_p), ("destroy_event", c_void_p)),
        *(("hash", c_void_p), ("description", c_void_p), ("sources", c_void_p)),
    )


class _Hash(Structure):  # rosidl_type_hash_t
    _fields_ = (("version", c_uint8), ("value", c_uint8 * 32))


@dataclass(frozen=True)
class TypeName:
    """A type's name, such as `std_msgs/msg/String`, and its hash, such as `RIHS01_4f...`."""

    package: str
    kind: str
    name: str
    hash: str


@dataclass(frozen=True)
class MessageType(TypeName):
    """A message's type, and the address of its description for Fast DDS."""

    introspection: int = 0


def message_support(
    message: MessageType, to_bytes: Callable[[Any], bytes], from_bytes: Callable[[bytes], Any]
) -> dict[str, Any]:
    """Return the attributes that rclpy needs in the metaclass of a message class.

    Args:
        message: the message's type.
        to_bytes: returns the CDR of a message, without a header. If it raises a ValueError, rclpy raises an error.
        from_bytes: returns the message of a CDR. If it raises a ValueError, rclpy receives None.
    """

    def create() -> int:
        number = next(_numbers)
        _messages[number] = None
        return number

    def from_python(message: Any, number: int) -> bool:
        try:
            _messages[number] = to_bytes(message)
        except ValueError:
            return False
        return True

    def to_python(number: int) -> Any:
        data = _messages.get(number)
        try:
            return None if data is None else from_bytes(data)
        except ValueError:
            return None

    def destroy(number: int) -> None:
        _messages.pop(number, None)

    functions = (_Create(create), _FromPython(from_python), _ToPython(to_python), _Destroy(destroy))
    addresses = [*map(_address, functions), ctypes.addressof(_message_support(message))]
    _kept_alive.append(functions)
    return dict(zip(NAMES, map(_capsule, addresses), strict=True))


@cache
def require_known_layout() -> None:
    """Raise a GraderError if this Fast CDR has another layout, so that no message is lost silently."""
    from rclpy.serialization import deserialize_message

    name = MessageType("autograder", "msg", "Probe", f"RIHS01_{'0' * 64}")
    meta: Any = type("Metaclass", (type,), message_support(name, bytes, bytes))
    if deserialize_message(LITTLE_ENDIAN + bytes(2) + b"probe", meta("Probe", (), {})) != b"probe":
        raise GraderError("the layout of this Fast CDR is not known, so no message of a student's type can be read")


def service_support(service: TypeName, request: MessageType, response: MessageType) -> dict[str, Any]:
    """Return the attribute that rclpy needs in the metaclass of a service class."""
    parts = [ctypes.addressof(_message_support(name)) for name in (request, response)]
    template = _templates()["service"]
    callbacks = _ServiceCallbacks(_namespace(service), service.name.encode(), *parts)
    support = _Service(
        *(template.identifier, ctypes.addressof(callbacks), template.handle, *parts, None, None, None),
        *(_hash(service.hash), template.description, template.sources),
    )
    _kept_alive.extend((callbacks, support))
    return {"_TYPE_SUPPORT": _capsule(ctypes.addressof(support))}


@cache
def _message_support(message: MessageType) -> MessageSupport:
    template = _templates()["message"]
    serialize, deserialize, size, maximum_size = _functions()
    callbacks = _MessageCallbacks(
        *(_namespace(message), message.name.encode(), serialize, deserialize, size, maximum_size, None)
    )
    support = MessageSupport(
        *(template.identifier, ctypes.addressof(callbacks), None, _hash(message.hash)),
        *(template.description, template.sources),
    )
    handles = {ctypes.string_at(template.identifier): ctypes.addressof(support), IDENTIFIER: message.introspection}
    handle = _Handle(lambda _, identifier: handles.get(identifier, 0))
    support.handle = _address(handle)
    _kept_alive.extend((callbacks, support, handle))
    return support


@cache
def _functions() -> tuple[Any, ...]:
    """Return the functions that all types share. They copy bytes between `_messages` and a `Cdr`."""
    library = ctypes.CDLL("libfastcdr.so.2")
    write = library["_ZN8eprosima7fastcdr3Cdr15serialize_arrayEPKcm"]
    write.argtypes, write.restype = (c_void_p, c_char_p, c_size_t), c_void_p
    start = library["_ZN8eprosima7fastcdr3Cdr18get_buffer_pointerEv"]
    position = library["_ZN8eprosima7fastcdr3Cdr20get_current_positionEv"]
    for function in (start, position):
        function.argtypes, function.restype = (c_void_p,), c_void_p

    def serialize(number: int, cdr: int) -> bool:
        data = _messages.get(number)
        if data is None:
            return False
        write(cdr, data, len(data))
        return True

    def deserialize(cdr: int, number: int) -> bool:
        first, current = start(cdr) or 0, position(cdr) or 0
        # Three iterators, each with the start of the buffer and a position: the current one, the origin, and the end.
        positions = (c_void_p * 6).from_address(cdr + POSITIONS_OFFSET)
        end = positions[5] or 0
        if [positions[0], positions[1], positions[2], positions[4]] == [
            first,
            current,
            first,
            first,
        ] and current == first + HEADER_SIZE <= end:
            readable = ctypes.string_at(first, HEADER_SIZE)[:2] == LITTLE_ENDIAN and end - current <= MAX_BYTES
            _messages[number] = ctypes.string_at(current, end - current) if readable else None
        return True  # a message that cannot be read has nevertheless arrived, and counts

    def maximum_size(bounds: Any) -> int:
        bounds[0] = b"\0"  # unbounded
        return INITIAL_SIZE

    functions = (
        *(_Serialize(serialize), _Serialize(deserialize)),
        *(_Size(lambda number: len(_messages.get(number) or b"")), _MaximumSize(maximum_size)),
    )
    _kept_alive.append(functions)
    return functions


@cache
def _templates() -> Mapping[str, Any]:
    """Return the structures of two existing types, from which other types copy the parts that are the same for all.

    These include the description of the type. It is wrong for the other types, but nobody requests it from the grader.
    """
    from std_msgs.msg import Empty as EmptyMessage
    from std_srvs.srv import Empty as EmptyService

    identifier = c_void_p.in_dll(
        ctypes.CDLL("librosidl_typesupport_fastrtps_c.so"), "rosidl_typesupport_fastrtps_c__identifier"
    )
    library = ctypes.CDLL("librosidl_runtime_c.so")
    supports = {}
    for kind, interface, structure in (("message", EmptyMessage, MessageSupport), ("service", EmptyService, _Service)):
        meta: Any = type(interface)
        meta.__import_type_support__()
        support = structure.from_buffer_copy(structure.from_address(_pointer(meta._TYPE_SUPPORT)))
        support.identifier = identifier.value
        support.handle = _address(library[f"get_{kind}_typesupport_handle_function"])
        supports[kind] = support
    return supports


def _hash(text: str) -> int:
    """Return the address of a function that returns a type's hash."""
    value = _Hash(1, (c_uint8 * 32)(*bytes.fromhex(text.partition("_")[2])))
    function = _Get(lambda _: ctypes.addressof(value))
    _kept_alive.append(function)
    return _address(function)


def _namespace(type_name: TypeName) -> bytes:
    return f"{type_name.package}::{type_name.kind}".encode()


def _address(function: Any) -> int:
    return cast(function, c_void_p).value or 0


def _capsule(address: int) -> Any:
    make = ctypes.pythonapi.PyCapsule_New
    make.argtypes, make.restype = (c_void_p, c_char_p, c_void_p), ctypes.py_object
    return make(address, None, None)


def _pointer(capsule: Any) -> int:
    get = ctypes.pythonapi.PyCapsule_GetPointer
    get.argtypes, get.restype = (ctypes.py_object, c_char_p), c_void_p
    return int(get(capsule, None))
