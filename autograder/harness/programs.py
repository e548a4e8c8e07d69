"""The programs of a harness, the files that the grader gives them, and errors that name their program."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from autograder.exceptions import StudentError
from autograder.ros.discovery import PROFILES, PROFILES_VARIABLE
from autograder.sandbox import Mount, Sandbox
from autograder.workspace import Workspace

FILES = "{files}"  # replaced in arguments by the folder of the harness's files
_PROFILES = ".profiles.xml"


@dataclass(frozen=True)
class Program:
    """An executable of a package, and its arguments."""

    package: str
    executable: str
    arguments: tuple[str, ...] = ()

    def words(self, folder: str) -> tuple[str, ...]:
        """Return the arguments, `FILES` replaced by the folder of the harness's files."""
        return tuple(argument.replace(FILES, folder) for argument in self.arguments)


def write_files(files: Mapping[str, str], workspace: Workspace, sandbox: Sandbox) -> tuple[Sandbox, str]:
    """Write files where programs in a sandbox can read them and only the grader can write.

    The grader adds a file of its own: with it, programs that start together find each other at once.

    Args:
        files: texts by name.
        workspace: whose root gets the folder.
        sandbox: of the programs.

    Returns:
        The sandbox with the folder mounted, and the folder.
    """
    folder = Path(tempfile.mkdtemp(prefix=".harness-", dir=workspace.root))
    for name, text in {**files, _PROFILES: PROFILES}.items():
        (folder / name).write_text(text, encoding="utf-8")
    environment = {**sandbox.environment, PROFILES_VARIABLE: str(folder / _PROFILES)}
    return replace(sandbox, mounts=(*sandbox.mounts, Mount(folder)), environment=environment), str(folder)


def error_of(program: Program, error: StudentError, count: int) -> StudentError:
    """Return a program's error, which names the program where there are several.

    Args:
        program: which failed.
        error: what it raised.
        count: how many programs there are.
    """
    if count == 1:
        return error
    return StudentError(replace(error.diagnosis, sentence=f"{program.executable}: {error.diagnosis.sentence}"))
