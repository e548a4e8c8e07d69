"""What a command and a verb are, and the parsers built from them.

Only the parser of the verb that was asked for is filled in, so `ros2 pkg list` never imports rclpy.
"""

from __future__ import annotations

import argparse
import importlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from autograder.ros.ros2.exceptions import HOW_TO_GET_THE_REAL_ONE, NotCoveredError

STAND_IN_NOTE = f"This is a stand-in for ros2cli, without a daemon. The real one: {HOW_TO_GET_THE_REAL_ONE}."

# What a verb returns: nothing or 0 for success, another exit code, or a text for stderr (exit code 1).
ExitCode = int | str | None


@dataclass(frozen=True)
class Verb:
    """One thing that a command does.

    Attributes:
        name: as typed, such as `list`.
        summary: one sentence for `--help`.
        add_arguments: fills in the verb's parser.
        run: does it, given the parsed arguments.
    """

    name: str
    summary: str
    add_arguments: Callable[[argparse.ArgumentParser], None]
    run: Callable[[argparse.Namespace], ExitCode]


@dataclass(frozen=True)
class Command:
    """A first word after `ros2`.

    Attributes:
        summary: one sentence for `--help`.
        module: where its `VERBS` (or, without verbs, its `VERB`) are; `None` for a command that is not covered.
        not_covered: verbs of the real command that this one lacks.
    """

    summary: str
    module: str | None = None
    not_covered: tuple[str, ...] = ()

    def load(self) -> tuple[Verb, ...] | Verb:
        """Import the verbs of a covered command, or its one verb if it has no further word."""
        module = importlib.import_module(f"autograder.ros.ros2.{self.module}")
        found: tuple[Verb, ...] | Verb = module.VERBS if hasattr(module, "VERBS") else module.VERB
        return found


def parse(
    commands: dict[str, Command], argv: Sequence[str]
) -> tuple[Callable[[argparse.Namespace], ExitCode], argparse.Namespace]:
    """Parse a whole command line.

    Returns:
        What to run, and the parsed arguments to run it with.

    Raises:
        NotCoveredError: the command or verb exists only in the real `ros2`.
        SystemExit: help was asked for, or the arguments are wrong (as argparse does it).
    """
    top = _parser("ros2", "ros2 is an extensible command-line tool for ROS 2.")
    top.add_argument(
        "--use-python-default-buffering",
        action="store_true",
        help="do not force line buffering of stdout",
    )
    words = [word for word in argv if not word.startswith("-")]
    name = words[0] if words else None
    children = top.add_subparsers(
        title="Commands", metavar="Call `ros2 <command> -h` for more detailed usage.", dest="command"
    )
    for known, command in commands.items():
        if command.module is not None:
            child = children.add_parser(known, help=command.summary, prog=f"ros2 {known}")
            child.set_defaults(run=lambda _: None)
    if name in commands:
        # Filled in now that it is known which one; the placeholder made for the list of commands gives way.
        children.choices[name] = _command_parser(name, commands[name], words)
    args = top.parse_args(argv)
    if args.command is None:
        top.print_help()
        return (lambda _: 0), args
    return args.run, args


def _command_parser(name: str, command: Command, words: Sequence[str]) -> argparse.ArgumentParser:
    if command.module is None:
        raise NotCoveredError(f"`ros2 {name}`")
    verbs = command.load()
    parser = _parser(f"ros2 {name}", command.summary)
    if isinstance(verbs, Verb):
        verbs.add_arguments(parser)
        parser.set_defaults(run=verbs.run)
        return parser
    asked = words[1] if len(words) > 1 else None
    if asked in command.not_covered:
        raise NotCoveredError(f"`ros2 {name} {asked}`")
    children = parser.add_subparsers(
        title="Verbs", metavar=f"Call `ros2 {name} <verb> -h` for more detailed usage.", dest="verb"
    )
    for verb in verbs:
        child = children.add_parser(
            verb.name,
            help=verb.summary,
            description=verb.summary,
            epilog=STAND_IN_NOTE,
            prog=f"ros2 {name} {verb.name}",
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        child.set_defaults(run=verb.run)
        if verb.name == asked:
            verb.add_arguments(child)

    def show_help(_: argparse.Namespace) -> int:
        parser.print_help()
        return 0

    parser.set_defaults(run=show_help)
    return parser


def _parser(prog: str, description: str) -> argparse.ArgumentParser:
    return argparse.ArgumentParser(
        prog=prog,
        description=description,
        epilog=STAND_IN_NOTE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )


def positive_int(text: str) -> int:
    """Parse an argument that has to be a whole number above 0."""
    return _whole(text, 1, "positive")


def unsigned_int(text: str) -> int:
    """Parse an argument that has to be a whole number, 0 included."""
    return _whole(text, 0, "non-negative")


def positive_float(text: str) -> float:
    """Parse an argument that has to be a finite number above 0."""
    try:
        value = float(text)
    except ValueError:
        raise argparse.ArgumentTypeError("Expects a floating point number") from None
    if not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError("Value must be positive")
    return value


def _whole(text: str, least: int, kind: str) -> int:
    try:
        value = int(text)
    except ValueError:
        value = least - 1
    if value < least:
        raise argparse.ArgumentTypeError(f"value must be a {kind} integer")
    return value
