"""Runs a program of a student's package by itself, without a harness."""

from __future__ import annotations

import sys
from dataclasses import dataclass

from autograder.run.sandbox.launcher import launch
from autograder.run.workspace import Workspace


@dataclass(frozen=True)
class ProgramRun:
    """The exit status of a program, negative for a signal and None if it still ran, and all that it printed."""

    status: int | None
    output: str


def run_program(
    workspace: Workspace, package: str, executable: str, arguments: tuple[str, ...], seconds: float
) -> ProgramRun:
    """Run an installed program in its sandbox for at most `seconds` of real time, then end it.

    Raises:
        StudentError: the package does not install it.
    """
    command = [sys.executable, str(workspace.executable(package, executable)), *arguments]
    with launch(command, workspace.sandbox()) as process:
        process.wait(seconds)
        return ProgramRun(process.returncode, process.output)
