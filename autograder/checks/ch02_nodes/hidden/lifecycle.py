"""Checks of how the program ends: after Ctrl-C, after a launch system's SIGTERM, and after an error of its own."""

from __future__ import annotations

import signal

from autograder.checking import Workspace, expect, group, hint
from autograder.checking.probes import programs
from autograder.checks.ch02_nodes.support.contract import EXECUTABLE, PACKAGE
from autograder.checks.ch02_nodes.support.shutdown import HINTS, START_SECONDS, expect_clean_end, last_line

check = group("lifecycle")
LONG_NAME = "a" * 300  # ROS refuses names of 256 letters or more


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
@hint("In `except RuntimeError`, a bare `raise` hands the error on. Where rclpy.ok() is false, a signal was its cause.")
@hint("`finally` runs also where the node was never made: node = None before `try` says so.")
def test_fails(workspace: Workspace) -> None:
    """Where its node cannot be made, it ends with that error and another exit status than 0."""
    arguments = ("--ros-args", "-r", f"__node:={LONG_NAME}")
    result = programs.run_program(workspace, PACKAGE, EXECUTABLE, arguments, START_SECONDS)
    status, output = result.status, result.output
    case = f"Started with a node name of {len(LONG_NAME)} letters, which ROS refuses,"
    expect(status is not None, f"{case} it did not end within {START_SECONDS:.0f} s.")
    expect(status != 0, f"{case} it ended with exit status 0, as if it had been asked to: the error was swallowed.")
    # The class or the text of an exception contains "error"; the warnings that rclpy logs here do not.
    names_error = "error" in output.lower()
    expect(names_error, f"{case} it ended with exit status {status}, and did not say which error it was.", fraction=0.5)
    expect("another exception" not in output, f"{case} its clean-up failed, too: {last_line(output)}", fraction=0.5)
