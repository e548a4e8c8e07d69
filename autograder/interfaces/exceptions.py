"""Errors of building and loading interface packages.

InterfaceError
├── DefinitionError      a .msg, .srv or .action text is wrong; its author can mend it
├── GenerationError      the definitions read well, but the generators or the compiler would not have them
└── AlreadyLoadedError   another version of the package is in this process
"""

from __future__ import annotations


class InterfaceError(Exception):
    """Base of every error about an interface package."""


class DefinitionError(InterfaceError):
    """A definition is wrong.

    Attributes:
        file: the file's path in its package.
        line: the text of the line that is wrong, empty if it is the whole file.
    """

    def __init__(self, file: str, problem: str, line: str = "") -> None:
        where = f"{file}, line “{line[:120]}”" if line else file
        super().__init__(f"{where}: {problem}")
        self.file, self.line = file, line


class GenerationError(InterfaceError):
    """The generators or the compiler failed on definitions that read well."""


class AlreadyLoadedError(InterfaceError):
    """Two versions of a package cannot live in one process."""
