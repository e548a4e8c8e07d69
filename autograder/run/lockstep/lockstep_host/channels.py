"""Names for channels, which connect writers and readers. The host and the grader use the same names.

DDS matches a writer with a reader when names and types are equal and the writer offers the quality of service that the
reader requests. A channel's name contains all of these, so each of its readers will receive as many messages as are
sent on it. A response is sent to only one client, so its channel contains the prefix of the GUIDs of the client's
process.
"""

from __future__ import annotations

import ctypes
from typing import Any

RELIABLE, BEST_EFFORT = "reliable", "best-effort"
TRANSIENT_LOCAL, VOLATILE = "transient_local", "volatile"
OWN = "own"  # a placeholder for the prefix of the client's process until the prefix is known
PREFIX = 12  # bytes of a GUID that identify the process
_GUID = 16  # bytes of a GUID
_VALUE = object.__basicsize__  # offset of the address of the C struct in a pybind11 object


def type_name(kind: Any) -> str:
    """Return the ROS name of a message, service or action class, such as `std_msgs/msg/String`."""
    package, family = kind.__module__.split(".")[:2]
    return f"{package}/{family}/{kind.__name__}"


def publisher_channel(topic: str, kind: Any, qos: Any) -> str:
    """Return the channel of a publisher with a QoS profile. `topic` is the resolved name."""
    reliability = BEST_EFFORT if qos.reliability.name == "BEST_EFFORT" else RELIABLE
    durability = TRANSIENT_LOCAL if qos.durability.name == "TRANSIENT_LOCAL" else VOLATILE
    return _topic(topic, kind, reliability, durability)


def subscription_channels(topic: str, kind: Any, qos: Any) -> tuple[str, ...]:
    """Return the channels of a subscription with a QoS profile: all that offer at least what the profile requests."""
    reliabilities = (RELIABLE,) if qos.reliability.name == "RELIABLE" else (RELIABLE, BEST_EFFORT)
    durabilities = (TRANSIENT_LOCAL,) if qos.durability.name == "TRANSIENT_LOCAL" else (TRANSIENT_LOCAL, VOLATILE)
    return tuple(
        _topic(topic, kind, reliability, durability) for reliability in reliabilities for durability in durabilities
    )


def topic_of(channel: str) -> str:
    """Return a channel's topic or service."""
    return channel.partition(" ")[0]


def is_transient_local(channel: str) -> bool:
    """Return whether late readers receive earlier messages."""
    return channel.endswith(f" {TRANSIENT_LOCAL}")


def request(service: str, kind: Any) -> str:
    """Return the channel of a service's requests."""
    return f"{service} {type_name(kind)} request"


def is_topic(channel: str) -> bool:
    """Return whether a channel belongs to a topic, not to a service."""
    return channel.endswith((f" {VOLATILE}", f" {TRANSIENT_LOCAL}"))


def response(service: str, kind: Any, prefix: str) -> str:
    """Return the channel of a service's responses to the process whose GUIDs have a prefix."""
    return f"{service} {type_name(kind)} response {prefix}"


def with_process_prefix(names: tuple[str, ...], prefix: str) -> tuple[str, ...]:
    """Return channels with the prefix of a process instead of `OWN`."""
    return tuple(f"{name[: -len(OWN)]}{prefix}" if name.endswith(f" response {OWN}") else name for name in names)


def client_prefix(request_id: Any) -> str:
    """Return the prefix of the process that sent a request, or an empty string if it cannot be read.

    rclpy does not expose the client's GUID. In memory, the GUID precedes the sequence number, which serves as a check.
    """
    address = ctypes.c_void_p.from_address(id(request_id) + _VALUE).value
    if not address or ctypes.c_int64.from_address(address + _GUID).value != request_id.sequence_number:
        return ""
    return ctypes.string_at(address, PREFIX).hex()


def own_prefix(node: Any) -> str:
    """Return the prefix of a node's process, or an empty string if the graph does not contain the node yet."""
    name, space = node.get_name(), node.get_namespace()
    for endpoint in node.get_publishers_info_by_topic("/parameter_events"):
        if (endpoint.node_name, endpoint.node_namespace) == (name, space):
            return bytes(endpoint.endpoint_gid)[:PREFIX].hex()
    return ""


def _topic(topic: str, kind: Any, reliability: str, durability: str) -> str:
    return f"{topic} {type_name(kind)} {reliability} {durability}"
