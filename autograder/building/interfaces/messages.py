"""Message classes of plain Python values, made of parsed definitions: rclpy takes them, and no code is generated.

They look like rosidl's classes: fields with their defaults, constants, `Request` and `Response` of a service, `Goal`,
`Result` and `Feedback` of an action. Messages of ROS's own packages in them are the real ones.
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
    """A student's package lacks an interface or a field that the contract asks for, or has it with another type."""

    def __init__(self, what: str, problem: str) -> None:
        super().__init__(Diagnosis(Kind.HALF_WRITTEN_PACKAGE, f"{what} {problem}."))


class Interfaces(SimpleNamespace):
    """The messages, services or actions of a package, by name."""

    _where: str

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(name) if name.startswith("_") else FieldError(self._where, f"has no {name}")


class PlainMessage:
    """Base of the message classes. Its own names begin with an underscore, which no field and no constant does."""

    _type: ClassVar[rosidl.NamespacedType]
    _members: ClassVar[Mapping[str, rosidl.AbstractType]]
    _defaults: ClassVar[Mapping[str, Callable[[], Any]]]  # of the fields
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
        """Return the fields, in their order, with the names that rosidl has for their types."""
        return {name: structures.describe(cls._members[name]) for name in cls._defaults}

    @classmethod
    def _of(cls, values: Mapping[str, Any]) -> PlainMessage:
        """Make a message of the values of all members."""
        message = cls.__new__(cls)
        vars(message).update({name: values[name] for name in cls._defaults})
        return message


def to_bytes(message: PlainMessage) -> bytes:
    """Return a message's CDR, without a header. Raises ValueError where a value does not fit."""
    kind = type(message)
    writer = cdr.Writer(kind._known.members)
    writer.write(kind._type, message)
    return bytes(writer.data)


def from_bytes(kind: type[PlainMessage], data: bytes) -> PlainMessage:
    """Return the message of a CDR. Raises ValueError where it does not fit."""
    message: PlainMessage = cdr.Reader(data, kind._known.members, kind._known.make).read(kind._type)
    return message


def add_package(package: str, definitions: tuple[Definition, ...], known: KnownTypes) -> SimpleNamespace:
    """Make the classes of a package and add them to those that are known.

    Returns:
        The classes as the package's modules would hold them: `.msg.RobotStatus`, `.srv.CheckTrip`, ... One that is not
        it raises a StudentError.
    """
    models = [structures.model(package, definition) for definition in definitions]
    known.describe(models)
    kinds = {kind: Interfaces(_where=f"{package}/{kind}") for kind in KINDS}
    for model, definition in zip(models, definitions, strict=True):
        made = _made(model, definition.sections, known)
        setattr(kinds[definition.path.split("/")[0]], made.__name__, made)
    return SimpleNamespace(**kinds)


def _made(model: Any, sections: tuple[Section, ...], known: KnownTypes) -> Any:
    """Return the class of a message, service or action."""
    if isinstance(model, rosidl.Message):
        return _message(model, sections[0], known)
    if isinstance(model, rosidl.Service):
        return _service(model, sections, known)
    goal, result, feedback = (
        _message(message, section, known)
        for message, section in zip((model.goal, model.result, model.feedback), sections, strict=True)
    )
    nothing = (Section(), Section())
    implementation = SimpleNamespace(
        SendGoalService=_service(model.send_goal_service, nothing, known),
        GetResultService=_service(model.get_result_service, nothing, known),
        CancelGoalService=CancelGoal,
        FeedbackMessage=_message(model.feedback_message, Section(), known),
        GoalStatusMessage=GoalStatusArray,
    )
    parts = {"Goal": goal, "Result": result, "Feedback": feedback, "Impl": implementation}
    return _class(type, model.namespaced_type, (), parts)


def _message(message: rosidl.Message, section: Section, known: KnownTypes) -> Any:
    """Return a message's class; `section` has its constants and the defaults of its fields."""
    kind = message.structure.namespaced_type
    given = {field.name: field.default for field in section.fields}
    members = {member.name: member.type for member in message.structure.members}
    content = {
        **{constant.name: constant.value for constant in section.constants},
        "_type": kind,
        "_members": members,
        "_defaults": {
            name: defaults.of(inner, given.get(name), known.make)
            for name, inner in members.items()
            if name != structures.EMPTY.name
        },
        "_known": known,
    }

    def support() -> dict[str, Any]:
        type_support.require_known_layout()
        return type_support.message_support(_message_type(kind, known), to_bytes, lambda data: from_bytes(made, data))

    made = _class(_metaclass(support, type_support.NAMES), kind, (PlainMessage,), content)
    known.add(kind, made)
    return made


def _service(service: rosidl.Service, sections: tuple[Section, ...], known: KnownTypes) -> Any:
    messages = (service.request_message, service.response_message)
    request, response = (_message(message, section, known) for message, section in zip(messages, sections, strict=True))

    def support() -> dict[str, Any]:
        for part in (request, response):
            type(part).__import_type_support__()
        package, kind, name = service.namespaced_type.namespaced_name()
        type_name = TypeName(package, kind, name, known.hash(service.namespaced_type))
        parts = (_message_type(part._type, known) for part in (request, response))
        return type_support.service_support(type_name, *parts)

    parts = {"Request": request, "Response": response}
    return _class(_metaclass(support, ("_TYPE_SUPPORT",)), service.namespaced_type, (), parts)


def _message_type(kind: rosidl.NamespacedType, known: KnownTypes) -> MessageType:
    package, family, name = kind.namespaced_name()
    return MessageType(package, family, name, known.hash(kind), addressof(known.introspection.support(kind)))


def _class(meta: Any, kind: rosidl.NamespacedType, bases: tuple[type, ...], content: dict[str, Any]) -> Any:
    module = ".".join(kind.namespaces)
    return meta(kind.name, bases, {**content, "__module__": module, "__doc__": f"{module}.{kind.name}"})


def _metaclass(support: Callable[[], dict[str, Any]], names: tuple[str, ...]) -> type:
    """Return a metaclass in which rclpy finds the type support, which is made when it first asks."""

    def import_type_support(meta: type) -> None:
        if meta._TYPE_SUPPORT is None:  # type: ignore[attr-defined]
            for name, value in support().items():
                setattr(meta, name, value)

    content: dict[str, Any] = {**dict.fromkeys(names), "__import_type_support__": classmethod(import_type_support)}
    return type("Metaclass", (type,), content)
