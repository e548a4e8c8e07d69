"""Queries the ROS graph for nodes, topics and services, and for their types."""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from rclpy.expand_topic_name import expand_topic_name
from rclpy.node import Node
from rclpy.validate_full_topic_name import validate_full_topic_name

from autograder.ros.ros2.exceptions import Ros2Error
from autograder.ros.ros2.session import Session

NamesAndTypes = list[tuple[str, list[str]]]


@dataclass(frozen=True, order=True)
class NodeName:
    """The name and the namespace of a node."""

    name: str
    namespace: str

    @property
    def full_name(self) -> str:
        """Namespace and name, such as `/robot/driver`."""
        return f"{self.namespace.rstrip('/')}/{self.name}"

    @property
    def is_hidden(self) -> bool:
        """Whether the name begins with an underscore, like the names of this command's own nodes."""
        return self.name.startswith("_")

    @classmethod
    def parse(cls, text: str) -> NodeName:
        """Split a name that a user typed, with or without the leading slash."""
        namespace, _, name = f"/{text.lstrip('/')}".rpartition("/")
        return cls(name, namespace or "/")


def has_hidden_part(name: str) -> bool:
    """Return whether a topic or service is hidden, that is, whether a part of its name begins with an underscore."""
    return any(part.startswith("_") for part in name.split("/"))


def node_names(session: Session, *, include_hidden: bool = False) -> list[NodeName]:
    """Return the nodes discovered so far."""
    nodes = (NodeName(name, namespace) for name, namespace in session.node.get_node_names_and_namespaces())
    return [node for node in nodes if include_hidden or not node.is_hidden]


def topic_names_and_types(session: Session, *, include_hidden: bool = False) -> NamesAndTypes:
    """Return the topics discovered so far, sorted by name."""
    return _visible_names(session.node.get_topic_names_and_types(), include_hidden)


def service_names_and_types(session: Session, *, include_hidden: bool = False) -> NamesAndTypes:
    """Return the services discovered so far, sorted by name."""
    return _visible_names(session.node.get_service_names_and_types(), include_hidden)


def _visible_names(names_and_types: Any, include_hidden: bool) -> NamesAndTypes:
    return sorted((name, types) for name, types in names_and_types if include_hidden or not has_hidden_part(name))


def find_node(
    session: Session, text: str, *, include_hidden: bool = True, timeout: float | None = None
) -> NodeName | None:
    """Wait for the node that the user named, and return it, or `None` if it does not appear before `timeout`."""
    node = NodeName.parse(text)
    if node.is_hidden and not include_hidden:
        return None
    is_discovered = session.wait_for(lambda: node in node_names(session, include_hidden=True), timeout)
    return node if is_discovered else None


def full_topic_name(node: Node, topic: str) -> str:
    """Expand a topic's name relative to the node's name and namespace.

    Raises:
        Ros2Error: the name is not valid. The message is rclpy's.
    """
    try:
        name: str = expand_topic_name(topic, node.get_name(), node.get_namespace())
        validate_full_topic_name(name)
    except ValueError as error:
        raise Ros2Error(str(error)) from None
    return name


def types_of_topic(session: Session, name: str, timeout: float | None = None) -> list[str]:
    """Wait for the topic with this full name, and return its types, or an empty list if it does not appear."""
    return _wait_for_types(session, name, session.node.get_topic_names_and_types, timeout)


def types_of_service(session: Session, name: str) -> list[str]:
    """Wait for the service with this full name, and return its types, or an empty list if it does not appear."""
    return _wait_for_types(session, name, session.node.get_service_names_and_types, None)


def _wait_for_types(session: Session, name: str, query: Callable[[], Any], timeout: float | None) -> list[str]:
    session.wait_for(lambda: name in dict(query()), timeout)
    return list(dict(query()).get(name, []))


def message_class_of(session: Session, topic: str, *, blocking: bool = False) -> Any:
    """Wait until a topic has a publisher or subscriber, and return the class of its messages.

    Args:
        session: the session whose graph is queried.
        topic: the topic's name, expanded or not.
        blocking: whether to wait forever. Otherwise, the session's timeout applies.

    Returns:
        The class, or `None` if the topic did not appear.

    Raises:
        Ros2Error: the topic has two types, or its type cannot be imported.
    """
    name = full_topic_name(session.node, topic)
    types = types_of_topic(session, name)
    if not types:
        print(f"WARNING: topic [{topic}] does not appear to be published yet")
        if not blocking:
            return None
        types = types_of_topic(session, name, timeout=math.inf)
    if len(types) > 1:
        raise Ros2Error(f"Cannot echo topic '{topic}', as it contains more than one type: [{', '.join(types)}]")
    return load_class(types[0], "msg")


def load_class(type_name: str, kind: str) -> Any:
    """Import the class of a message (`kind` is `msg`), service (`srv`) or action (`action`).

    Raises:
        Ros2Error: the class cannot be imported.
    """
    from rosidl_runtime_py.utilities import get_action, get_message, get_service

    load = {"msg": get_message, "srv": get_service, "action": get_action}[kind]
    noun = {"msg": "message", "srv": "service", "action": "action"}[kind]
    try:
        return load(type_name)
    except (AttributeError, ModuleNotFoundError, ValueError) as error:
        hint = "" if re.fullmatch(r"[\w/]+", type_name) else " (expected package/kind/Name)"
        raise Ros2Error(f"The passed {noun} type is invalid: '{type_name}'{hint}: {error}") from None


def warn_of_duplicates(names: list[NodeName]) -> None:
    """Warn on stderr if two nodes have the same name."""
    if len(set(names)) < len(names):
        print(
            "WARNING: Be aware that there are nodes in the graph that share an exact name, "
            "which can have unintended side effects.",
            file=sys.stderr,
        )
