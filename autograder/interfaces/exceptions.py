"""Errors of building and loading interface packages."""

from __future__ import annotations


class InterfaceError(Exception):
    """Base of every error about an interface package."""


class DefinitionError(InterfaceError):
    """A definition is wrong, and its author can mend it; names the file and, if it is one, the line's text."""

    def __init__(self, file: str, problem: str, line: str = "") -> None:
        where = f"{file}, line “{line[:120]}”" if line else file
        super().__init__(f"{where}: {problem}")
        self.file, self.line = file, line


class GenerationError(InterfaceError):
    """The generators or the compiler failed on definitions that read well."""


class AlreadyLoadedError(InterfaceError):
    """Two versions of a package cannot live in one process."""
