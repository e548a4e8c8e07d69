"""`ros2 param`: list, get, set, describe, dump and load, which call a node's parameter services."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import yaml
from rcl_interfaces.msg import ParameterDescriptor, ParameterType
from rclpy.parameter import parameter_value_to_python

from autograder.ros.ros2 import graph
from autograder.ros.ros2.exceptions import Ros2Error
from autograder.ros.ros2.param_client import NodeParameters, nested
from autograder.ros.ros2.parsing import ExitCode, Verb
from autograder.ros.ros2.session import add_session_arguments, open_session

_TYPES = {
    ParameterType.PARAMETER_NOT_SET: "not set",
    ParameterType.PARAMETER_BOOL: "boolean",
    ParameterType.PARAMETER_INTEGER: "integer",
    ParameterType.PARAMETER_DOUBLE: "double",
    ParameterType.PARAMETER_STRING: "string",
    ParameterType.PARAMETER_BYTE_ARRAY: "byte array",
    ParameterType.PARAMETER_BOOL_ARRAY: "boolean array",
    ParameterType.PARAMETER_INTEGER_ARRAY: "integer array",
    ParameterType.PARAMETER_DOUBLE_ARRAY: "double array",
    ParameterType.PARAMETER_STRING_ARRAY: "string array",
}


@contextmanager
def _open_parameters(args: argparse.Namespace) -> Iterator[NodeParameters]:
    with open_session(args) as session:
        timeout = getattr(args, "timeout", None)
        node = graph.find_node(session, args.node_name, include_hidden=args.include_hidden_nodes, timeout=timeout)
        if node is None:
            raise Ros2Error("Node not found")
        yield NodeParameters(session, node.full_name)


def _node_arguments(parser: argparse.ArgumentParser) -> None:
    add_session_arguments(parser)
    parser.add_argument("node_name", help="Name of the ROS node")
    parser.add_argument("--include-hidden-nodes", action="store_true", help="Consider hidden nodes as well")
    parser.add_argument("--timeout", metavar="N", type=int, help="Wait for N seconds until node becomes available")


def _list_arguments(parser: argparse.ArgumentParser) -> None:
    add_session_arguments(parser)
    parser.add_argument("node_name", nargs="?", help="Name of the ROS node")
    parser.add_argument("--include-hidden-nodes", action="store_true", help="Consider hidden nodes as well")
    parser.add_argument(
        "--param-prefixes", nargs="+", default=[], help="Only list parameters with the provided prefixes"
    )
    parser.add_argument("--param-type", action="store_true", help="Print parameter types with parameter names")
    parser.add_argument("--filter", type=_pattern, help="Only list parameters matching the regular expression")


def _pattern(text: str) -> re.Pattern[str]:
    try:
        return re.compile(text)
    except re.error as error:
        raise argparse.ArgumentTypeError(f"'{text}' is not a regular expression: {error}") from None


def _list(args: argparse.Namespace) -> ExitCode:
    if args.node_name:
        with _open_parameters(args) as parameters:
            _print_names(parameters, args)
        return None
    with open_session(args) as session:
        session.settle()
        for node in sorted(graph.node_names(session, include_hidden=args.include_hidden_nodes)):
            try:
                _print_names(NodeParameters(session, node.full_name), args, heading=f"{node.full_name}:")
            except Ros2Error as error:
                print(f"Exception while calling service of node '{node.full_name}': {error}", file=sys.stderr)
    return None


def _print_names(parameters: NodeParameters, args: argparse.Namespace, *, heading: str | None = None) -> None:
    names = [name for name in parameters.names(args.param_prefixes) if not args.filter or args.filter.match(name)]
    if heading and names:
        print(heading)
    if args.param_type and names:
        for descriptor in parameters.descriptors(names):
            print(f"  {descriptor.name} (type: {_TYPES[descriptor.type]})")
        return
    for name in names:
        print(f"  {name}")


def _get_arguments(parser: argparse.ArgumentParser) -> None:
    _node_arguments(parser)
    parser.add_argument("parameter_name", help="Name of the parameter")
    parser.add_argument("--hide-type", action="store_true", help="Hide the type information")


def _get(args: argparse.Namespace) -> ExitCode:
    with _open_parameters(args) as parameters:
        values = parameters.values([args.parameter_name])
    if not values:
        return "Parameter not set"
    message = values[0]
    if message.type == ParameterType.PARAMETER_NOT_SET:
        print("Parameter not set.")
        return None
    kind = _TYPES[message.type]
    label = f"{kind.removesuffix(' array').capitalize()} {'values are' if kind.endswith('array') else 'value is'}:"
    value = parameter_value_to_python(message)
    value = list(value) if hasattr(value, "typecode") else value
    print(value if args.hide_type else f"{label} {value}")
    return None


def _set_arguments(parser: argparse.ArgumentParser) -> None:
    _node_arguments(parser)
    parser.add_argument("parameter_name", help="Name of the parameter")
    parser.add_argument("value", help="Value of the parameter")


def _set(args: argparse.Namespace) -> ExitCode:
    with _open_parameters(args) as parameters:
        result = parameters.set(args.parameter_name, args.value)
    return _print_result(result, "Set parameter successful", "Setting parameter failed")


def _print_result(result: Any, success: str, failure: str) -> ExitCode:
    """Print the result of a change. As in the real command, the exit code is 0 even if the node rejected it."""
    reason = f": {result.reason}" if result.reason else ""
    print(f"{success if result.successful else failure}{reason}", file=sys.stdout if result.successful else sys.stderr)
    return None


def _describe_arguments(parser: argparse.ArgumentParser) -> None:
    _node_arguments(parser)
    parser.add_argument("parameter_names", nargs="+", help="Names of the parameters")


def _describe(args: argparse.Namespace) -> ExitCode:
    with _open_parameters(args) as parameters:
        for descriptor in parameters.descriptors(args.parameter_names):
            print(*describe(descriptor), sep="\n")
    return None


def describe(descriptor: ParameterDescriptor) -> Iterator[str]:
    """Yield the lines that describe a parameter."""
    yield f"Parameter name: {descriptor.name}"
    yield f"  Type: {_TYPES[descriptor.type]}"
    if descriptor.description:
        yield f"  Description: {descriptor.description}"
    yield "  Constraints:"
    if descriptor.read_only:
        yield "    Read only: true"
    for limits in [*descriptor.floating_point_range, *descriptor.integer_range][:1]:
        yield f"    Min value: {limits.from_value}"
        yield f"    Max value: {limits.to_value}"
        if limits.step:
            yield f"    Step: {limits.step}"
    if descriptor.additional_constraints:
        yield f"    Additional constraints: {descriptor.additional_constraints}"


def _dump(args: argparse.Namespace) -> ExitCode:
    with _open_parameters(args) as parameters:
        names = parameters.names([])
        values = [parameter_value_to_python(value) for value in parameters.values(names)]
    plain = [list(value) if hasattr(value, "typecode") else value for value in values]
    full_name = graph.NodeName.parse(args.node_name).full_name
    tree = {full_name: {"ros__parameters": nested(dict(zip(names, plain, strict=True)))}}
    print(yaml.dump(tree, default_flow_style=False))
    return None


def _load_arguments(parser: argparse.ArgumentParser) -> None:
    _node_arguments(parser)
    parser.add_argument("parameter_file", help="Parameter file")
    parser.add_argument("--no-use-wildcard", action="store_true", help="Do not load parameters in the '/**' namespace")


def _load(args: argparse.Namespace) -> ExitCode:
    with _open_parameters(args) as parameters:
        for name, result in parameters.load(Path(args.parameter_file), not args.no_use_wildcard):
            _print_result(result, f"Set parameter {name} successful", f"Set parameter {name} failed")
    return None


VERBS = (
    Verb("describe", "Show descriptive information about declared parameters", _describe_arguments, _describe),
    Verb("dump", "Show all of the parameters of a node in a YAML file format", _node_arguments, _dump),
    Verb("get", "Get parameter", _get_arguments, _get),
    Verb("list", "Output a list of available parameters", _list_arguments, _list),
    Verb("load", "Load parameter file for a node", _load_arguments, _load),
    Verb("set", "Set parameter", _set_arguments, _set),
)
