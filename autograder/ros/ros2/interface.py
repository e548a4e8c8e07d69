"""`ros2 interface`: list, show and package."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from autograder.ros.ros2.exceptions import Ros2Error
from autograder.ros.ros2.interface_text import unfold
from autograder.ros.ros2.parsing import ExitCode, Verb

_KINDS = (("m", "msg", "Messages"), ("s", "srv", "Services"), ("a", "action", "Actions"))


def _kind_arguments(parser: argparse.ArgumentParser) -> None:
    for letter, kind, plural in _KINDS:
        parser.add_argument(
            f"-{letter}", f"--only-{kind}s", action="store_true", help=f"Print out only the {plural.lower()}"
        )


def _chosen(args: argparse.Namespace, packages: tuple[str, ...] = ()) -> list[tuple[str, dict[str, list[str]]]]:
    """Return a heading and the interfaces by package, for each kind asked for, all kinds by default.

    Raises:
        LookupError: one of `packages` does not exist, or has no interfaces.
    """
    from rosidl_runtime_py import get_action_interfaces, get_message_interfaces, get_service_interfaces

    getters = {"msg": get_message_interfaces, "srv": get_service_interfaces, "action": get_action_interfaces}
    asked = [kind for _, kind, _ in _KINDS if getattr(args, f"only_{kind}s")]
    return [(plural, getters[kind](packages)) for _, kind, plural in _KINDS if not asked or kind in asked]


def _list(args: argparse.Namespace) -> ExitCode:
    for heading, by_package in _chosen(args):
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
        chosen = _chosen(args, (args.package_name,))
    except LookupError as error:
        return _message(error)
    for name in sorted(name for _, found in chosen for name in found.get(args.package_name, ())):
        print(f"{args.package_name}/{name}")
    return None


def _show_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "type",
        help="Show an interface definition (e.g. 'std_msgs/msg/String'). '-' reads the name from stdin "
        "(e.g. 'ros2 topic type /chatter | ros2 interface show -')",
    )
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--all-comments", action="store_true", help="Show all comments, including for nested interfaces")
    which.add_argument("--no-comments", action="store_true", help="Show no comments or whitespace")


def _show(args: argparse.Namespace) -> ExitCode:
    name = _name(args.type)
    lines = unfold(name, _read, comments=not args.no_comments, nested_comments=args.all_comments)
    try:
        # Complete before anything is printed: an unknown nested type then gives an error alone.
        print(*list(lines), sep="\n")
    except (LookupError, ValueError) as error:
        return _message(error)
    return None


def _read(name: str) -> str:
    from rosidl_runtime_py import get_interface_path

    return Path(get_interface_path(name)).read_text(encoding="utf-8")


def _name(text: str) -> str:
    if text != "-":
        return text
    if sys.stdin.isatty():
        raise Ros2Error("expected stdin pipe")
    return sys.stdin.readline().strip()


def _message(error: Exception) -> str:
    return str(error.args[0]) if error.args else str(error)


VERBS = (
    Verb("list", "List all interface types available", _kind_arguments, _list),
    Verb("package", "Output a list of available interface types within one package", _package_arguments, _package),
    Verb("show", "Output the interface definition", _show_arguments, _show),
)
