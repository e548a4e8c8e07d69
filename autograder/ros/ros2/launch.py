"""`ros2 launch`: finds a launch file and passes it to `launch`, the real one or its stand-in."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

from autograder.ros.ros2 import packages
from autograder.ros.ros2.exceptions import INSTALL_HINT, Ros2Error
from autograder.ros.ros2.parsing import ExitCode, Verb

OVERRIDE_VARIABLE = "OVERRIDE_LAUNCH_PROCESS_OUTPUT"  # read by `launch`, the real one or its stand-in
_SUFFIXES = ("launch.py", "launch.xml", "launch.yaml", "launch.yml")


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "-n",
        "--noninteractive",
        action="store_true",
        default=not sys.stdin.isatty(),
        help="Run the launch system non-interactively, with no terminal associated",
    )
    parser.add_argument(
        "-d", "--debug", action="store_true", help="Put the launch system in debug mode, provides more verbose output"
    )
    modes = parser.add_mutually_exclusive_group()
    modes.add_argument(
        "-p",
        "--print",
        "--print-description",
        dest="print_description",
        action="store_true",
        help="Print the launch description to the console without launching it",
    )
    modes.add_argument(
        "-s",
        "--show-args",
        "--show-arguments",
        dest="show_args",
        action="store_true",
        help="Show arguments that may be given to the launch file",
    )
    parser.add_argument(
        "-a",
        "--show-all-subprocesses-output",
        action="store_true",
        help="Show all launched subprocesses' output by overriding their output configuration using the "
        f"{OVERRIDE_VARIABLE} envvar",
    )
    parser.add_argument("--launch-prefix", help="Prefix command, which should go before all executables")
    parser.add_argument(
        "--launch-prefix-filter",
        help="Regex pattern for filtering which executables the --launch-prefix is applied to by matching the "
        "executable name",
    )
    parser.add_argument(
        "package_name", help="Name of the ROS package which contains the launch file, or path of a launch file"
    )
    parser.add_argument("launch_file_name", nargs="?", help="Name of the launch file")
    parser.add_argument(
        "launch_arguments",
        nargs="*",
        help="Arguments to the launch file; '<name>:=<value>' (for duplicates, last one wins)",
    )


def _run(args: argparse.Namespace) -> ExitCode:
    path, words = find_launch_file(args.package_name, args.launch_file_name, args.launch_arguments)
    arguments = launch_arguments(words)
    if args.launch_prefix is not None:
        arguments["launch-prefix"] = args.launch_prefix
    if args.launch_prefix_filter is not None:
        arguments["launch-prefix-filter"] = args.launch_prefix_filter
    if args.show_all_subprocesses_output:
        os.environ[OVERRIDE_VARIABLE] = "both"
    try:
        import launch
        from launch.launch_description_sources import AnyLaunchDescriptionSource
    except ModuleNotFoundError as error:
        return f"`ros2 launch` needs the Python package launch ({error}): {INSTALL_HINT}"
    source = AnyLaunchDescriptionSource(str(path))
    if args.show_args or args.print_description:
        description = source.get_launch_description(launch.LaunchContext(argv=words, noninteractive=True))
        if args.show_args:
            # `launch_testing` prints the arguments in the same format.
            from launch_testing.print_arguments import print_arguments_of_launch_description

            print_arguments_of_launch_description(launch_description=description)
        else:
            print(launch.LaunchIntrospector().format_launch_description(description))
        return None
    service = launch.LaunchService(argv=words, noninteractive=args.noninteractive, debug=args.debug)
    include = launch.actions.IncludeLaunchDescription(source, launch_arguments=arguments.items())
    service.include_launch_description(launch.LaunchDescription([include]))
    code: int = service.run()
    return code


def find_launch_file(package: str, name: str | None, words: list[str]) -> tuple[Path, list[str]]:
    """Find a launch file by its package and name, or by its path alone.

    Returns:
        The file's path, and the remaining words, which are launch arguments.

    Raises:
        Ros2Error: no such package or file, or several files of that name.
    """
    path = Path(package)
    if path.is_file():
        return path.absolute(), ([name] if name is not None else []) + words
    if "/" in package or package.endswith(_SUFFIXES):
        raise Ros2Error(f"File '{package}' not found")
    prefix = packages.prefix_of(package)
    if name is None:
        raise Ros2Error("launch_file_name is required when package_name is not a path to a launch file")
    share = prefix / "share" / package
    paths = sorted(path for path in share.rglob(Path(name).name) if path.is_file() and str(path).endswith(f"/{name}"))
    if not paths:
        raise Ros2Error(
            f"file '{name}' was not found in the share directory of package '{package}' which is at '{share}'"
        )
    if len(paths) > 1:
        raise Ros2Error(f"file '{name}' was found more than once in package '{package}': {', '.join(map(str, paths))}")
    return paths[0], words


def launch_arguments(words: list[str]) -> dict[str, str]:
    """Parse words of the form `<name>:=<value>`. The last word with a name takes precedence.

    Raises:
        Ros2Error: a word has a different form.
    """
    arguments: dict[str, str] = {}
    for word in words:
        name, separator, value = word.partition(":=")
        if not separator or not name or not value:
            raise Ros2Error(f"malformed launch argument '{word}', expected format '<name>:=<value>'")
        arguments[name] = value
    return arguments


VERB = Verb("launch", "Run a launch file", _arguments, _run)
