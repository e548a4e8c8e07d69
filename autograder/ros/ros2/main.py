"""The entry point of `ros2`: runs the real command if it is installed, and otherwise the stand-in."""

from __future__ import annotations

import contextlib
import importlib
import importlib.util
import os
import signal
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn

from autograder.ros import RosError, activate
from autograder.ros.ros2.exceptions import Ros2Error
from autograder.ros.ros2.parsing import Command, ExitCode, parse

STANDINS_FOLDER = Path(__file__).parents[1] / "standins"

COMMANDS = {
    "action": Command("Various action related sub-commands", "action", ("echo", "find", "info", "type")),
    "bag": Command("Various rosbag related sub-commands"),
    "component": Command("Various component related sub-commands"),
    "control": Command("Various control related sub-commands"),
    "daemon": Command("Various daemon related sub-commands"),
    "doctor": Command("Check ROS setup and other potential issues", "doctor", ("hello",)),
    "interface": Command("Show information about ROS interfaces", "interface", ("packages", "proto")),
    "launch": Command("Run a launch file", "launch"),
    "lifecycle": Command("Various lifecycle related sub-commands"),
    "multicast": Command("Various multicast related sub-commands"),
    "node": Command("Various node related sub-commands", "node"),
    "param": Command("Various param related sub-commands", "param", ("delete",)),
    "pkg": Command("Various package related sub-commands", "pkg", ("dependencies", "xml")),
    "run": Command("Run a package specific executable", "run"),
    "security": Command("Various security related sub-commands"),
    "service": Command("Various service related sub-commands", "service", ("echo", "find", "type")),
    "test": Command("Run a ROS2 launch test"),
    "topic": Command("Various topic related sub-commands", "topic", ("bw", "delay", "find", "type")),
    "trace": Command("Trace ROS 2 nodes"),
    "wtf": Command("Use `wtf` as alias to `doctor`", "doctor", ("hello",)),
}


def main(argv: Sequence[str] | None = None) -> ExitCode:
    """Run `ros2` and return its exit code, or the text of an error (for `sys.exit`, which prints it and exits with 1).

    The exit code is 2 after Ctrl-C and 15 after SIGTERM, as in the real command.
    """
    arguments = list(sys.argv[1:] if argv is None else argv)
    try:
        activate()
    except RosError as error:
        return str(error)
    try:
        if importlib.util.find_spec("ros2cli") is not None:
            outcome: ExitCode = importlib.import_module("ros2cli.cli").main(argv=arguments)
            return outcome
        return run_stand_in(arguments)
    except BrokenPipeError:
        # The reader closed the pipe, as in `ros2 topic echo /scan | head`. With stdout redirected, Python does not
        # raise the error again when it closes stdout.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1


def run_stand_in(arguments: Sequence[str]) -> ExitCode:
    """Run the stand-in for `ros2`, with ROS active. Return its exit code, or the text of an error."""
    if str(STANDINS_FOLDER) not in sys.path:
        sys.path.append(str(STANDINS_FOLDER))
    if "--use-python-default-buffering" not in arguments:
        sys.stdout.reconfigure(line_buffering=True)  # type: ignore[union-attr]
    previous_handler = signal.signal(signal.SIGTERM, _terminate)
    try:
        run, args = parse(COMMANDS, arguments)
        return run(args)
    except Ros2Error as error:
        return str(error)
    except KeyboardInterrupt:
        return int(signal.SIGINT)
    finally:
        signal.signal(signal.SIGTERM, previous_handler)


def run() -> NoReturn:
    """Run `ros2` and end this process with its exit code.

    Python's finalization is skipped, because it can wait forever for a thread of Fast DDS on a busy machine.
    """
    try:
        outcome = main()
    except SystemExit as error:
        outcome = error.code
    if isinstance(outcome, str):
        print(outcome, file=sys.stderr)
        outcome = 1
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError):  # the reader may have closed the pipe
            stream.flush()
    os._exit(outcome or 0)


def _terminate(signum: int, _: object) -> NoReturn:
    """Exit through the `finally` clauses, so that nodes and child processes are shut down."""
    raise SystemExit(signum)
