"""Commands and their verbs, and the argument parsers that are built from them.

Only the parser of the requested verb gets its arguments, so `ros2 pkg list` never imports rclpy.
"""

from __future__ import annotations

import argparse
import importlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from autograder.ros.ros2.exceptions import INSTALL_HINT, NotCoveredError

STAND_IN_NOTE = f"This is a stand-in for ros2cli, without a daemon. The real one: {INSTALL_HINT}."

# The return value of a verb: None or 0 for success, another exit code, or a text for stderr (exit code 1).
ExitCode = int | str | None


@dataclass(frozen=True)
class Verb:
    """A verb of a command, such as `list` in `ros2 topic list`.

    Attributes:
        name: the word that the user types.
        summary: one sentence for `--help`.
        add_arguments: a function that adds the verb's arguments to its parser.
        run: a function that runs the verb with the parsed arguments.
    """

    name: str
    summary: str
    add_arguments: Callable[[argparse.ArgumentParser], None]
    run: Callable[[argparse.Namespace], ExitCode]


@dataclass(frozen=True)
class Command:
    """A command, such as `topic` in `ros2 topic`.

    Attributes:
        summary: one sentence for `--help`.
        module: the module that defines `VERBS`, or `VERB` if the command has no verbs; `None` if it is not covered.
        not_covered: the verbs that only the real command has.
    """

    summary: str
    module: str | None = None
    not_covered: tuple[str, ...] = ()

    def load(self) -> tuple[Verb, ...] | Verb:
        """Import the `VERBS` or the `VERB` of a covered command."""
        module = importlib.import_module(f"autograder.ros.ros2.{self.module}")
        verbs: tuple[Verb, ...] | Verb = module.VERBS if hasattr(module, "VERBS") else module.VERB
        return verbs


def parse(
    commands: dict[str, Command], argv: Sequence[str]
) -> tuple[Callable[[argparse.Namespace], ExitCode], argparse.Namespace]:
    """Parse a whole command line.

    Returns:
        The function to run, and the parsed arguments to call it with.

    Raises:
        NotCoveredError: the command or verb exists only in the real `ros2`.
        SystemExit: raised by argparse, if help was requested or the arguments are not valid.
    """
    top = _parser("ros2", "ros2 is an extensible command-line tool for ROS 2.")
    top.add_argument(
        "--use-python-default-buffering",
        action="store_true",
        help="do not force line buffering of stdout",
    )
    words = [word for word in argv if not word.startswith("-")]
    name = words[0] if words else None
    subparsers = top.add_subparsers(
        title="Commands", metavar="Call `ros2 <command> -h` for more detailed usage.", dest="command"
    )
    for command_name, command in commands.items():
        if command.module is not None:
            subparser = subparsers.add_parser(command_name, help=command.summary, prog=f"ros2 {command_name}")
            subparser.set_defaults(run=lambda _: None)
    if name in commands:
        # The complete parser replaces the placeholder, which was created for the list of commands.
        subparsers.choices[name] = _command_parser(name, commands[name], words)
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
    verb_name = words[1] if len(words) > 1 else None
    if verb_name in command.not_covered:
        raise NotCoveredError(f"`ros2 {name} {verb_name}`")
    subparsers = parser.add_subparsers(
        title="Verbs", metavar=f"Call `ros2 {name} <verb> -h` for more detailed usage.", dest="verb"
    )
    for verb in verbs:
        subparser = subparsers.add_parser(
            verb.name,
            help=verb.summary,
            description=verb.summary,
            epilog=STAND_IN_NOTE,
            prog=f"ros2 {name} {verb.name}",
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        subparser.set_defaults(run=verb.run)
        if verb.name == verb_name:
            verb.add_arguments(subparser)

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
    """Parse an argument that must be an integer above 0."""
    return _integer(text, 1, "positive")


def unsigned_int(text: str) -> int:
    """Parse an argument that must be an integer of at least 0."""
    return _integer(text, 0, "non-negative")


def positive_float(text: str) -> float:
    """Parse an argument that must be a finite number above 0."""
    try:
        value = float(text)
    except ValueError:
        raise argparse.ArgumentTypeError("Expects a floating point number") from None
    if not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError("Value must be positive")
    return value


def _integer(text: str, minimum: int, kind: str) -> int:
    try:
        value = int(text)
    except ValueError:
        value = minimum - 1
    if value < minimum:
        raise argparse.ArgumentTypeError(f"value must be a {kind} integer")
    return value
