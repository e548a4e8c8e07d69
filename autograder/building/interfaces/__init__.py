"""Message packages: a student's as plain classes for the trusted process, and ROS's tutorials' as real packages.

`load_from` reads a package of a student's workspace. Nothing of it is compiled or imported, and no line of its CMake or
Python runs. `prefix.build` turns the texts of a package of ours into a prefix with rosidl's own generators.
"""

from autograder.building.interfaces.cache import Cache
from autograder.building.interfaces.loading import load_from

__all__ = ["Cache", "load_from"]
