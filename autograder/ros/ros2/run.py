"""`ros2 run`: runs an executable of a package and exits with its exit code."""

from __future__ import annotations

import argparse
import shlex
import signal
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager

from autograder.ros.ros2 import packages
from autograder.ros.ros2.parsing import ExitCode, Verb


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--prefix",
        help="Prefix command, which should go before the executable. Command must be wrapped in quotes if it contains "
        "spaces (e.g. --prefix 'gdb -ex run --args')",
    )
    parser.add_argument("package_name", help="Name of the ROS package")
    parser.add_argument("executable_name", help="Name of the executable")
    parser.add_argument("argv", nargs=argparse.REMAINDER, help="Pass arbitrary arguments to the executable")


def _run(args: argparse.Namespace) -> ExitCode:
    paths = [path for path in packages.executables_of(args.package_name) if path.name == args.executable_name]
    if not paths:
        return "No executable found"
    if len(paths) > 1:
        return "\n".join(["Multiple executables found:", *(f"- {path}" for path in paths)])
    command = [*shlex.split(args.prefix or ""), str(paths[0]), *args.argv]
    try:
        child = subprocess.Popen(command)
    except OSError as error:
        return f"Cannot start {shlex.join(command)}: {error}"
    with _forward_signals(child):
        code = child.wait()
    if code < 0:
        print(f"[ros2run]: {signal.strsignal(-code)}")
    elif code:
        print(f"[ros2run]: Process exited with failure {code}")
    return code


@contextmanager
def _forward_signals(child: subprocess.Popen[bytes]) -> Iterator[None]:
    """Ignore SIGINT and forward SIGTERM to the child, so that this process outlives it and returns its exit code.

    A terminal sends Ctrl-C to both processes, but SIGTERM may be sent to this process alone.
    """
    previous_handlers = {
        signal.SIGINT: signal.signal(signal.SIGINT, lambda *_: None),
        signal.SIGTERM: signal.signal(signal.SIGTERM, lambda *_: child.terminate()),
    }
    try:
        yield
    finally:
        for number, handler in previous_handlers.items():
            signal.signal(number, handler)


VERB = Verb("run", "Run a package specific executable", _arguments, _run)
