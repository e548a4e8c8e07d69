"""Creates a message, request or goal from the YAML text that the user typed."""

from __future__ import annotations

import argparse
import sys
from typing import Any

import yaml
from rosidl_runtime_py import set_message_fields

from autograder.ros.ros2.exceptions import Ros2Error


def add_values_argument(parser: argparse.ArgumentParser, name: str, text: str) -> None:
    """Add the argument `name` for values in YAML (by default {}), with the help `text`, and the option `--stdin`."""
    group = parser.add_mutually_exclusive_group()
    group.add_argument(name, nargs="?", default="{}", help=text)
    group.add_argument("--stdin", action="store_true", help="Read the values from standard input")


def read_values(args: argparse.Namespace, name: str) -> str:
    """Return the YAML text that the user gave, as the argument `name` or on standard input."""
    return sys.stdin.read() if args.stdin else str(getattr(args, name))


def make_message(interface: Any, text: str, noun: str, *, allow_stamps: bool = True) -> tuple[Any, list[Any]]:
    """Create a message from YAML text.

    Args:
        interface: the message's class.
        text: a YAML dictionary of its fields.
        noun: what an error message calls the content of the message.
        allow_stamps: whether the value of a header may be `auto`, and that of a time `now`.

    Returns:
        The message, and a setter for each of its `auto` and `now` fields.

    Raises:
        Ros2Error: the text is not a YAML dictionary, or does not fit the message.
    """
    try:
        values = yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise Ros2Error(f"The passed value is not valid YAML: {error}") from None
    if not isinstance(values, dict) and allow_stamps:
        raise Ros2Error("The passed value needs to be a dictionary in YAML format")
    message = interface()
    try:
        if not isinstance(values, dict):
            raise TypeError(f"Value '{values}' is expected to be a dictionary but is a {type(values).__name__}")
        return message, set_message_fields(
            message, values, expand_header_auto=allow_stamps, expand_time_now=allow_stamps
        )
    except (AssertionError, AttributeError, OverflowError, TypeError, ValueError) as error:
        raise Ros2Error(f"Failed to populate {noun}: {error}") from None
