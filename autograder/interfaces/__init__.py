"""Message packages from their texts alone, for the trusted process: no line of CMake or Python of a student's runs.

`build` turns the texts of a package into a prefix, which a content-addressed cache keeps, and `load` makes it
importable in this process. `load_from` does both for a package in a student's workspace.
"""

from autograder.interfaces.cache import Cache
from autograder.interfaces.definitions import DefinitionError, InterfaceError
from autograder.interfaces.loading import AlreadyLoadedError, load, load_from
from autograder.interfaces.prefix import GenerationError, build

__all__ = [
    "AlreadyLoadedError",
    "Cache",
    "DefinitionError",
    "GenerationError",
    "InterfaceError",
    "build",
    "load",
    "load_from",
]
