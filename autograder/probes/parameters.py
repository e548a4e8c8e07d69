"""Reads and changes a node's parameters through its services, and describes differences in sentences for the student.

    node = NodeParameters(harness, "/configured_node")
    node.values("safety_distance")         # {"safety_distance": 0.5}
    node.change({"safety_distance": 9.0})  # SetParametersReply(accepted=False, reason="... out of range ...")

A student can forge a node's answers. Messages shorten them, and checks rely on them only if the behaviour agrees.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from difflib import SequenceMatcher
from pathlib import Path
from typing import Any

import yaml
from rcl_interfaces.msg import ParameterDescriptor, ParameterType
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParametersAtomically
from rclpy.parameter import Parameter

from autograder.harness import Harness
from autograder.harness.parameter_values import value_of
from autograder.plain_text import comparable
from autograder.probes import student_yaml
from autograder.probes.files import read_plain
from autograder.submission.reading import beyond_bounds, reading, reason
from autograder.suite import CheckFailed

Value = bool | int | float | str | list[object] | None

RCLPY_PARAMETERS = frozenset({"use_sim_time", "start_type_description_service"})  # rclpy declares them on every node
TIMEOUT = 5.0  # s of the node's time to wait for an answer
MAX_QUOTE = 200  # characters of a node's answer
MIN_RATIO = 0.6  # the smallest difflib ratio of a near miss
MAX_FILE = 64 * 1024
MAX_PARAMETERS = 100  # the most parameters that a node may declare
TYPE_NAMES = {
    ParameterType.PARAMETER_NOT_SET: "of no type yet",
    ParameterType.PARAMETER_BOOL: "a bool",
    ParameterType.PARAMETER_INTEGER: "an integer",
    ParameterType.PARAMETER_DOUBLE: "a double",
    ParameterType.PARAMETER_STRING: "a string",
}


@dataclass(frozen=True)
class SetParametersReply:
    """A node's answer to a request to change parameters; `reason` is its shortened reason for rejecting them."""

    accepted: bool
    reason: str = ""


@dataclass(frozen=True)
class NodeParameters:
    """The parameter services of the node with the fully qualified name `node`."""

    harness: Harness
    node: str

    def names(self) -> frozenset[str]:
        """Return the names of all declared parameters except rclpy's. Raise a CheckFailed if there are too many."""
        response = self._ask(ListParameters, "list_parameters", ListParameters.Request())
        names = frozenset(response.result.names) - RCLPY_PARAMETERS
        if len(names) > MAX_PARAMETERS:
            raise CheckFailed(f"The node has {len(names):,} parameters: declare at most {MAX_PARAMETERS}.")
        return names

    def values(self, *names: str) -> dict[str, Value]:
        """Return the values of parameters by name, without those of undeclared names."""
        # One request for each name, because a node returns no values if one of the names is unknown.
        answers = {
            name: self._ask(GetParameters, "get_parameters", GetParameters.Request(names=[name])) for name in names
        }
        return {name: value_of(answer.values[0], name) for name, answer in answers.items() if answer.values}

    def descriptors(self, *names: str) -> dict[str, ParameterDescriptor]:
        """Return the descriptors of parameters by name, without those of undeclared names."""
        requests = {name: DescribeParameters.Request(names=[name]) for name in names}
        answers = {name: self._ask(DescribeParameters, "describe_parameters", r) for name, r in requests.items()}
        return {name: answer.descriptors[0] for name, answer in answers.items() if answer.descriptors}

    def change(self, values: Mapping[str, Value]) -> SetParametersReply:
        """Ask the node to set parameters in one request: its callback gets all of them in one list."""
        request = SetParametersAtomically.Request(
            parameters=[Parameter(name, value=value).to_parameter_msg() for name, value in values.items()]
        )
        result = self._ask(SetParametersAtomically, "set_parameters_atomically", request).result
        return SetParametersReply(result.successful, shortened(result.reason))

    def _ask(self, kind: Any, name: str, request: Any) -> Any:
        """Call one of the node's services. Raise a CheckFailed if it is missing or does not answer."""
        service = f"{self.node}/{name}"
        response = self.harness.call(kind, service, request, TIMEOUT)
        if response is not None:
            return response
        if not self.harness.node.count_services(service):
            raise CheckFailed(f"The node has no service {service}: keep its parameter services enabled.")
        raise CheckFailed(f"The node did not answer a request to {service} within {TIMEOUT:.0f} s.")


def shortened(text: str) -> str:
    """Return a text on one line of bounded length."""
    line = " ".join(text.split())
    return line if len(line) <= MAX_QUOTE else f"{line[:MAX_QUOTE]}…"


def near_misses(expected: Collection[str], actual: Collection[str]) -> dict[str, str]:
    """Return the missing expected names, each with the actual name that is probably a misspelling of it, or ''."""
    missing = sorted(set(expected) - set(actual))
    extra = comparable(sorted(set(actual) - set(expected)))
    ratios = {(name, other): SequenceMatcher(None, name, other).ratio() for name in missing for other in extra}
    near: dict[str, str] = {}
    for name, other in sorted(ratios, key=lambda pair: -ratios[pair]):
        if ratios[name, other] >= MIN_RATIO and name not in near and other not in near.values():
            near[name] = other
    return {name: near.get(name, "") for name in missing}


def missing_sentence(expected: Collection[str], actual: Collection[str]) -> str:
    """Name the expected parameters that a node does not declare, with near misses; '' if it declares all of them."""
    parts = [
        f"{name} (it declares {shortened(near)})" if near else name
        for name, near in near_misses(expected, actual).items()
    ]
    return f"The node does not declare {', '.join(parts)}." if parts else ""


def same(value: Value, expected: Value) -> bool:
    """Return whether a parameter has the expected value and type. Doubles may differ by rounding."""
    if type(value) is not type(expected):
        return False
    if isinstance(value, float) and isinstance(expected, float):
        return abs(value - expected) <= 1e-9
    return value == expected


def as_declared(values: Mapping[str, Value], declared: Mapping[str, Value]) -> dict[str, Value]:
    """Convert numbers to the type that a node declares, integer or double, so that a wrong type counts only once."""
    return {name: _in_type_of(declared.get(name), value) for name, value in values.items()}


def _in_type_of(declared: Value, value: Value) -> Value:
    if isinstance(value, (bool, str)) or not isinstance(value, (int, float)):
        return value
    if type(declared) is float:
        return float(value)
    return int(value) if type(declared) is int and math.isfinite(value) else value


def differences(values: Mapping[str, Value], expected: Mapping[str, Value]) -> list[str]:
    """Return a phrase without a full stop for each parameter whose value differs from the expected one."""
    return [
        f"{name} is {value_text(values.get(name))} instead of {value_text(value)}"
        for name, value in expected.items()
        if not same(values.get(name), value)
    ]


def value_text(value: Value) -> str:
    """Return a value as text in which 1, 1.0 and '1' differ."""
    return "not set" if value is None else shortened(repr(value))


def override_arguments(values: Mapping[str, Value]) -> list[str]:
    """Return the arguments after `--ros-args` that start a node with these parameter values."""
    return [word for name, value in values.items() for word in ("-p", f"{name}:={_in_yaml(value)}")]


def read_file(path: Path) -> dict[str, dict[str, Value]]:
    """Read a parameter file: for each node or wildcard, in the file's order, values by parameter.

    A CheckFailed says what to do if the file is missing, unfinished, not YAML, or not nested as ROS requires.
    """
    if path.is_symlink() or not path.is_file():
        raise CheckFailed(
            f"{path.parent.name}/{path.name} is not installed: write it into the package's config folder."
        )
    data = read_plain(path, MAX_FILE)
    if data is None:
        raise CheckFailed(f"{path.name} is far larger than a parameter file.")
    text = data.decode(errors="replace")
    if "NotImplementedError" in text:
        raise CheckFailed(
            f"{path.name} is still to be written: replace the line raise NotImplementedError(...) with your lines."
        )
    with reading(path.name):
        try:
            file = student_yaml.load(text)
        except (yaml.YAMLError, ValueError, RecursionError) as error:  # ValueError: PyYAML takes 2026-13-01 for a date
            raise CheckFailed(f"{path.name} is not YAML: {shortened(reason(error))}.") from None
        if not isinstance(file, dict):
            raise CheckFailed(
                f"{path.name} does not name a node: begin it with a node's name or with /**, and a colon."
            )
        return {str(node): _values(path.name, shortened(str(node)), below) for node, below in file.items()}


def for_node(file: Mapping[str, Mapping[str, Value]], name: str) -> dict[str, Value]:
    """Return the values from `read_file` that apply to a node, under a wildcard or its name without a namespace."""
    keys = ("/**", f"/**/{name}", name, f"/{name}")
    return {parameter: value for key in keys for parameter, value in file.get(key, {}).items()}


def _values(file: str, node: str, below: object) -> dict[str, Value]:
    if node == "ros__parameters":
        raise CheckFailed(f"In {file}, ros__parameters is at the left margin: indent it below a node's name.")
    if not isinstance(below, dict) or not below:
        raise CheckFailed(f"In {file}, nothing is below {node}: indent ros__parameters under it.")
    if set(below) != {"ros__parameters"}:
        other_names = _join_names(name for name in below if name != "ros__parameters")
        raise CheckFailed(
            f"In {file}, {other_names} is directly below {node}: ROS only reads the values below ros__parameters."
        )
    values = below["ros__parameters"]
    if not isinstance(values, dict) or not values:
        raise CheckFailed(f"In {file}, {node} has no values: indent them under its ros__parameters.")
    for name, value in values.items():
        if excess := beyond_bounds(value):
            raise CheckFailed(f"In {file}, {shortened(str(name))} is a {excess}, which ROS cannot store.")
    return {str(name): value for name, value in values.items()}


def _join_names(names: Iterable[object]) -> str:
    return ", ".join(shortened(str(name)) for name in names)


def _in_yaml(value: Value) -> str:
    """Return a value as YAML in one line, such as `.nan` for nan."""
    return str(yaml.safe_dump(value, width=math.inf)).partition("\n")[0]
