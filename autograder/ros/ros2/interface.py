"""`ros2 interface`: list, show and package."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from autograder.ros.ros2.exceptions import Ros2Error
from autograder.ros.ros2.interface_text import expand_lines
from autograder.ros.ros2.parsing import ExitCode, Verb

_KINDS = (("m", "msg", "Messages"), ("s", "srv", "Services"), ("a", "action", "Actions"))


def _kind_arguments(parser: argparse.ArgumentParser) -> None:
    for letter, kind, plural in _KINDS:
        parser.add_argument(
            f"-{letter}", f"--only-{kind}s", action="store_true", help=f"Print out only the {plural.lower()}"
        )


def _interfaces(args: argparse.Namespace, packages: tuple[str, ...] = ()) -> list[tuple[str, dict[str, list[str]]]]:
    """Return a heading and the interfaces, by package, of each kind that the options select (all by default).

    Raises:
        LookupError: one of `packages` does not exist, or has no interfaces.
    """
    from rosidl_runtime_py import get_action_interfaces, get_message_interfaces, get_service_interfaces

    getters = {"msg": get_message_interfaces, "srv": get_service_interfaces, "action": get_action_interfaces}
    kinds = [kind for _, kind, _ in _KINDS if getattr(args, f"only_{kind}s")]
    return [(plural, getters[kind](packages)) for _, kind, plural in _KINDS if not kinds or kind in kinds]


def _list(args: argparse.Namespace) -> ExitCode:
    for heading, by_package in _interfaces(args):
        print(f"{heading}:")
        for package in sorted(by_package):
            for name in sorted(by_package[package]):
                print(f"    {package}/{name}")
    return None


def _package_arguments(parser: argparse.ArgumentParser) -> None:
    _kind_arguments(parser)
    parser.add_argument("package_name", help="Name of the ROS package (e.g. 'std_msgs')")


def _package(args: argparse.Namespace) -> ExitCode:
    try:
        interfaces = _interfaces(args, (args.package_name,))
    except LookupError as error:
        return _error_text(error)
    for name in sorted(name for _, by_package in interfaces for name in by_package.get(args.package_name, ())):
        print(f"{args.package_name}/{name}")
    return None


def _show_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "type",
        help="Show an interface definition (e.g. 'std_msgs/msg/String'). '-' reads the name from stdin "
        "(e.g. 'ros2 topic type /chatter | ros2 interface show -')",
    )
    comment_options = parser.add_mutually_exclusive_group()
    comment_options.add_argument(
        "--all-comments", action="store_true", help="Show all comments, including for nested interfaces"
    )
    comment_options.add_argument("--no-comments", action="store_true", help="Show no comments or whitespace")


def _show(args: argparse.Namespace) -> ExitCode:
    name = _type_name(args.type)
    lines = expand_lines(name, _read_definition, comments=not args.no_comments, nested_comments=args.all_comments)
    try:
        # All lines are read before the first one is printed, so that only an error is printed for an unknown type.
        print(*list(lines), sep="\n")
    except (LookupError, ValueError) as error:
        return _error_text(error)
    return None


def _read_definition(name: str) -> str:
    from rosidl_runtime_py import get_interface_path

    return Path(get_interface_path(name)).read_text(encoding="utf-8")


def _type_name(text: str) -> str:
    if text != "-":
        return text
    if sys.stdin.isatty():
        raise Ros2Error("expected stdin pipe")
    return sys.stdin.readline().strip()


def _error_text(error: Exception) -> str:
    return str(error.args[0]) if error.args else str(error)


VERBS = (
    Verb("list", "List all interface types available", _kind_arguments, _list),
    Verb("package", "Output a list of available interface types within one package", _package_arguments, _package),
    Verb("show", "Output the interface definition", _show_arguments, _show),
)
