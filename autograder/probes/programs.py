"""Runs a program of a student's package without a harness."""

from __future__ import annotations

import sys
from dataclasses import dataclass

from autograder.run.sandbox.launcher import launch
from autograder.run.workspace import Workspace


@dataclass(frozen=True)
class ProgramRun:
    """The exit status and the output of a program."""

    status: int | None  # negative for a signal; None if the program had to be stopped
    output: str


def run_program(
    workspace: Workspace, package: str, executable: str, arguments: tuple[str, ...], seconds: float
) -> ProgramRun:
    """Run an installed program in its sandbox for at most `seconds` of real time, then stop it.

    Raises:
        StudentError: the package does not install the program.
    """
    command = [sys.executable, str(workspace.executable(package, executable)), *arguments]
    with launch(command, workspace.sandbox()) as process:
        process.wait(seconds)
        return ProgramRun(process.returncode, process.output)
