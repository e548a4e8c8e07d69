"""Creates message classes from parsed definitions. They hold plain values, and rclpy needs no generated code for them.

They have the attributes of rosidl's classes: fields with their defaults, constants, `Request` and `Response` of a
service, `Goal`, `Result` and `Feedback` of an action. For messages of ROS packages, fields use the real classes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from ctypes import addressof
from types import SimpleNamespace
from typing import Any, ClassVar

import numpy as np
from action_msgs.msg import GoalStatusArray
from action_msgs.srv import CancelGoal
from rosidl_parser import definition as rosidl

from autograder.building.interfaces import cdr, defaults, structures, type_support
from autograder.building.interfaces.definitions import KINDS, Definition, Section
from autograder.building.interfaces.known_types import KnownTypes
from autograder.building.interfaces.type_support import MessageType, TypeName
from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError


class FieldError(StudentError, AttributeError):
    """A student's package lacks an interface or a field that the contract requires, or has it with another type."""

    def __init__(self, name: str, problem: str) -> None:
        super().__init__(Diagnosis(Kind.HALF_WRITTEN_PACKAGE, f"{name} {problem}."))


class Interfaces(SimpleNamespace):
    """The messages, services or actions of a package, by name."""

    _label: str

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(name) if name.startswith("_") else FieldError(self._label, f"has no {name}")


class PlainMessage:
    """Base of the message classes. Unlike fields and constants, its attributes begin with an underscore."""

    _type: ClassVar[rosidl.NamespacedType]
    _members: ClassVar[Mapping[str, rosidl.AbstractType]]
    _defaults: ClassVar[Mapping[str, Callable[[], Any]]]  # functions that create the fields' initial values
    _known: ClassVar[KnownTypes]

    def __init__(self, **values: Any) -> None:
        vars(self).update({name: default() for name, default in self._defaults.items()})
        for name, value in values.items():
            setattr(self, name, value)

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in self._defaults:
            raise FieldError(self._type.name, f"has no field {name}")
        kind = self._members[name]
        try:
            cdr.Writer(self._known.members).write(kind, value)
        except ValueError:
            problem = f"is of the type {structures.describe(kind)}, and cannot be {value!r:.80}"
            raise FieldError(f"{self._type.name}.{name}", problem) from None
        vars(self)[name] = value

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(name) if name.startswith("_") else FieldError(self._type.name, f"has no field {name}")

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and all(np.array_equal(vars(self)[n], vars(other)[n]) for n in self._defaults)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"{self._type.name}({', '.join(f'{name}={value!r}' for name, value in vars(self).items())})"

    @classmethod
    def get_fields_and_field_types(cls) -> dict[str, str]:
        """Return the fields in order, each with rosidl's name for its type."""
        return {name: structures.describe(cls._members[name]) for name in cls._defaults}

    @classmethod
    def _from_values(cls, values: Mapping[str, Any]) -> PlainMessage:
        """Create a message from the values of all members."""
        message = cls.__new__(cls)
        vars(message).update({name: values[name] for name in cls._defaults})
        return message


def to_bytes(message: PlainMessage) -> bytes:
    """Return a message's CDR, without a header. Raise a ValueError if a value does not match its type."""
    message_class = type(message)
    writer = cdr.Writer(message_class._known.members)
    writer.write(message_class._type, message)
    return bytes(writer.data)


def from_bytes(message_class: type[PlainMessage], data: bytes) -> PlainMessage:
    """Return the message whose CDR is `data`. Raise a ValueError if the bytes do not match the type."""
    message: PlainMessage = cdr.Reader(data, message_class._known.members, message_class._known.make).read(
        message_class._type
    )
    return message


def add_package(package: str, definitions: tuple[Definition, ...], known: KnownTypes) -> SimpleNamespace:
    """Create the classes of a package, and add them to the known types.

    Returns:
        The classes as attributes, as in the package's modules: `.msg.RobotStatus`, `.srv.CheckTrip`, ... Reading an
        attribute that does not exist raises a StudentError.
    """
    models = [structures.model(package, definition) for definition in definitions]
    known.describe(models)
    kinds = {kind: Interfaces(_label=f"{package}/{kind}") for kind in KINDS}
    for model, definition in zip(models, definitions, strict=True):
        interface = _interface_class(model, definition.sections, known)
        setattr(kinds[definition.path.split("/")[0]], interface.__name__, interface)
    return SimpleNamespace(**kinds)


def _interface_class(model: Any, sections: tuple[Section, ...], known: KnownTypes) -> Any:
    """Return the class of a message, service or action."""
    if isinstance(model, rosidl.Message):
        return _message_class(model, sections[0], known)
    if isinstance(model, rosidl.Service):
        return _service_class(model, sections, known)
    goal, result, feedback = (
        _message_class(message, section, known)
        for message, section in zip((model.goal, model.result, model.feedback), sections, strict=True)
    )
    empty = (Section(), Section())
    implementation = SimpleNamespace(
        SendGoalService=_service_class(model.send_goal_service, empty, known),
        GetResultService=_service_class(model.get_result_service, empty, known),
        CancelGoalService=CancelGoal,
        FeedbackMessage=_message_class(model.feedback_message, Section(), known),
        GoalStatusMessage=GoalStatusArray,
    )
    parts = {"Goal": goal, "Result": result, "Feedback": feedback, "Impl": implementation}
    return _make_class(type, model.namespaced_type, (), parts)


def _message_class(message: rosidl.Message, section: Section, known: KnownTypes) -> Any:
    """Return a message's class. `section` contains its constants and the defaults of its fields."""
    kind = message.structure.namespaced_type
    default_values = {field.name: field.default for field in section.fields}
    members = {member.name: member.type for member in message.structure.members}
    content = {
        **{constant.name: constant.value for constant in section.constants},
        "_type": kind,
        "_members": members,
        "_defaults": {
            name: defaults.default_factory(inner, default_values.get(name), known.make)
            for name, inner in members.items()
            if name != structures.EMPTY.name
        },
        "_known": known,
    }

    def support() -> dict[str, Any]:
        type_support.require_known_layout()
        return type_support.message_support(
            _message_type(kind, known), to_bytes, lambda data: from_bytes(message_class, data)
        )

    message_class = _make_class(_metaclass(support, type_support.NAMES), kind, (PlainMessage,), content)
    known.add(kind, message_class)
    return message_class


def _service_class(service: rosidl.Service, sections: tuple[Section, ...], known: KnownTypes) -> Any:
    messages = (service.request_message, service.response_message)
    request, response = (
        _message_class(message, section, known) for message, section in zip(messages, sections, strict=True)
    )

    def support() -> dict[str, Any]:
        for part in (request, response):
            type(part).__import_type_support__()
        package, kind, name = service.namespaced_type.namespaced_name()
        type_name = TypeName(package, kind, name, known.hash(service.namespaced_type))
        parts = (_message_type(part._type, known) for part in (request, response))
        return type_support.service_support(type_name, *parts)

    parts = {"Request": request, "Response": response}
    return _make_class(_metaclass(support, ("_TYPE_SUPPORT",)), service.namespaced_type, (), parts)


def _message_type(kind: rosidl.NamespacedType, known: KnownTypes) -> MessageType:
    package, family, name = kind.namespaced_name()
    return MessageType(package, family, name, known.hash(kind), addressof(known.introspection.support(kind)))


def _make_class(meta: Any, kind: rosidl.NamespacedType, bases: tuple[type, ...], content: dict[str, Any]) -> Any:
    module = ".".join(kind.namespaces)
    return meta(kind.name, bases, {**content, "__module__": module, "__doc__": f"{module}.{kind.name}"})


def _metaclass(support: Callable[[], dict[str, Any]], names: tuple[str, ...]) -> type:
    """Return a metaclass for rclpy, whose type support is created on first use."""

    def import_type_support(meta: type) -> None:
        if meta._TYPE_SUPPORT is None:  # type: ignore[attr-defined]
            for name, value in support().items():
                setattr(meta, name, value)

    content: dict[str, Any] = {**dict.fromkeys(names), "__import_type_support__": classmethod(import_type_support)}
    return type("Metaclass", (type,), content)
