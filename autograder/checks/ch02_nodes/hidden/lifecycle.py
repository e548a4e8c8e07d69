"""Checks of how the program ends: after Ctrl-C, after a launch system's SIGTERM, and after an error of its own."""

from __future__ import annotations

import signal

from autograder.checking import Workspace, expect, group, hint
from autograder.checking.probes import programs
from autograder.checks.ch02_nodes.support.contract import EXECUTABLE, PACKAGE
from autograder.checks.ch02_nodes.support.shutdown import HINTS, START_SECONDS, expect_clean_end, last_line

check = group("lifecycle")
LONG_NAME = "a" * 300  # ROS rejects names of 256 characters or more


@check(points=2, covers="ends", needs=("starts",))
@hint(*HINTS)
def test_sigint(workspace: Workspace) -> None:
    """It ends with exit status 0, without a traceback, on Ctrl-C (SIGINT)."""
    expect_clean_end(workspace, signal.SIGINT)


@check(points=2, covers="ends", needs=("starts",))
@hint(*HINTS)
def test_sigterm(workspace: Workspace) -> None:
    """It ends with exit status 0, without a traceback, when a launch system stops it (SIGTERM)."""
    expect_clean_end(workspace, signal.SIGTERM)


@check(points=1, covers="fails", needs=("starts",))
@hint("In `except RuntimeError`, a bare `raise` raises the error again. If rclpy.ok() is false, a signal caused it.")
@hint("`finally` also runs if the node was never created. Set node = None before `try`, and test it in `finally`.")
def test_fails(workspace: Workspace) -> None:
    """If its node cannot be created, it ends with that error and an exit status other than 0."""
    arguments = ("--ros-args", "-r", f"__node:={LONG_NAME}")
    result = programs.run_program(workspace, PACKAGE, EXECUTABLE, arguments, START_SECONDS)
    status, output = result.status, result.output
    situation = f"Started with a node name of {len(LONG_NAME)} characters, which ROS rejects,"
    expect(status is not None, f"{situation} it did not end within {START_SECONDS:.0f} s.")
    expect(status != 0, f"{situation} it ended with exit status 0: the error was swallowed.")
    # The class or the text of an exception contains "error"; the warnings that rclpy logs here do not.
    names_error = "error" in output.lower()
    message = f"{situation} it ended with exit status {status}, but it did not print the error."
    expect(names_error, message, fraction=0.5)
    expect(
        "another exception" not in output, f"{situation} its clean-up failed, too: {last_line(output)}", fraction=0.5
    )
