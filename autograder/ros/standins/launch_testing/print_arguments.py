"""The arguments of a launch description, as `ros2 launch --show-args` and `launch_test --show-args` print them."""

from __future__ import annotations

from collections.abc import Iterator

from launch import LaunchDescription


def print_arguments_of_launch_description(*, launch_description: LaunchDescription) -> None:
    """Print the arguments of a launch description."""
    print(*_lines(launch_description), sep="\n")


def _lines(description: LaunchDescription) -> Iterator[str]:
    yield "Arguments (pass arguments as '<name>:=<value>'):"
    arguments = description.get_launch_arguments()
    if not arguments:
        yield "\n  No arguments."
    for argument in arguments:
        yield f"\n    '{argument.name}':{'*' if argument._conditionally_included else ''}"
        yield f"        {argument.description}"
        if argument.default_value is not None:
            yield f"        (default: {' + '.join(part.describe() for part in argument.default_value)})"
    if any(argument._conditionally_included for argument in arguments):
        yield "\n* argument(s) which are only used if specific conditions occur"
