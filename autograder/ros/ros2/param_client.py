"""Gets and sets a node's parameters through its services, and reads parameter files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterDescriptor
from rclpy.parameter import Parameter, get_parameter_value
from rclpy.parameter_client import AsyncParameterClient

from autograder.ros.ros2.exceptions import Ros2Error
from autograder.ros.ros2.session import Session

SERVICE_TIMEOUT = 5.0  # s; how long to wait until the node's services are ready


class NodeParameters:
    """A client of one node's parameter services.

    Each method raises Ros2Error if the node does not respond.
    """

    def __init__(self, session: Session, node_name: str) -> None:
        self._session = session
        self._client = AsyncParameterClient(session.node, node_name)
        if not session.wait_for(self._client.services_are_ready, SERVICE_TIMEOUT):
            raise Ros2Error("Wait for service timed out")

    def names(self, prefixes: list[str]) -> list[str]:
        """Return the sorted names of all parameters, or of those that begin with one of the prefixes."""
        return sorted(self._wait_for(self._client.list_parameters(prefixes, None)).result.names)

    def values(self, names: list[str]) -> list[Any]:
        """Return a ParameterValue for each name, or an empty list if one of them is not declared."""
        return list(self._wait_for(self._client.get_parameters(names)).values)

    def descriptors(self, names: list[str]) -> list[ParameterDescriptor]:
        """Return a descriptor for each name, or an empty list if one of them is not declared."""
        return list(self._wait_for(self._client.describe_parameters(names)).descriptors)

    def set(self, name: str, text: str) -> Any:
        """Set a parameter to the value in `text`, parsed as YAML. Return the SetParametersResult."""
        parameter = Parameter.from_parameter_msg(ParameterMessage(name=name, value=get_parameter_value(text)))
        return self._wait_for(self._client.set_parameters([parameter])).results[0]

    def load(self, path: Path, use_wildcard: bool) -> list[tuple[str, Any]]:
        """Set the parameters that a file contains for this node. Return each name with its SetParametersResult."""
        messages = parameters_in_file(path, self._client.remote_node_name, use_wildcard)
        parameters = [Parameter.from_parameter_msg(message) for message in messages.values()]
        return list(zip(messages, self._wait_for(self._client.set_parameters(parameters)).results, strict=True))

    def _wait_for(self, future: Any) -> Any:
        self._session.spin_until(future)
        return future.result()


def parameters_in_file(path: Path, node_name: str, use_wildcard: bool) -> dict[str, Any]:
    """Read the parameters that a YAML parameter file contains for a node, as messages by name.

    The node's own parameters override those of `/**`.

    Raises:
        Ros2Error: the file is missing, is not a parameter file, or has no parameters for this node.
    """
    try:
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise Ros2Error(f"Cannot read the parameter file {path}: {error}") from None
    if not isinstance(content, dict):
        raise Ros2Error(f"{path} is not a ROS parameter file: it has no node names at its top level")
    keys = [key for key in ("/**", node_name, node_name.lstrip("/")) if key in content]
    if not use_wildcard and "/**" in keys:
        keys.remove("/**")
    if not keys:
        raise Ros2Error(
            f"Param file does not contain parameters for {node_name}, only for nodes: {', '.join(map(str, content))}"
        )
    merged_values: dict[str, Any] = {}
    for key in keys:
        section = content[key]
        if not isinstance(section, dict) or not isinstance(section.get("ros__parameters"), dict):
            raise Ros2Error(f"{path} is not a ROS parameter file: {key} has no mapping named ros__parameters")
        merged_values |= _flatten(section["ros__parameters"])
    return {name: Parameter(name, value=value).to_parameter_msg() for name, value in merged_values.items()}


def nested(values: dict[str, Any]) -> dict[str, Any]:
    """Turn dotted parameter names into nested dictionaries."""
    tree: dict[str, Any] = {}
    for name, value in values.items():
        *groups, last = name.split(".")
        branch = tree
        for group in groups:
            branch = branch.setdefault(group, {})
        branch[last] = value
    return tree


def _flatten(values: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for key, value in values.items():
        flat |= _flatten(value, f"{prefix}{key}.") if isinstance(value, dict) else {f"{prefix}{key}": value}
    return flat
