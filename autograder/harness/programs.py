"""The programs of a harness, and errors that name their program."""

from __future__ import annotations

from dataclasses import dataclass, replace

from autograder.exceptions import StudentError


@dataclass(frozen=True)
class Program:
    """An executable of a package, and its arguments."""

    package: str
    executable: str
    arguments: tuple[str, ...] = ()


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
