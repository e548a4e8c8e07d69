"""Message packages from their texts alone, for the trusted process: no line of CMake or Python of a student's runs.

`load_from` makes a package of a student's workspace importable in this process. `prefix.build` turns the package's
texts into a prefix, which a content-addressed cache keeps, and `loading.load` imports it.
"""

from autograder.interfaces.cache import Cache
from autograder.interfaces.loading import load_from

__all__ = ["Cache", "load_from"]
