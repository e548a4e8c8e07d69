"""Loads students' interface packages as plain classes, and builds those of ROS's tutorials as real packages.

`load_interfaces` reads a package of a student's workspace for the trusted process. It does not compile or import
anything, and does not run the package's CMake or Python code. `prefix.build` builds a package from definitions of this
project with rosidl's generators.
"""

from autograder.building.interfaces.cache import Cache
from autograder.building.interfaces.loading import load_interfaces

__all__ = ["Cache", "load_interfaces"]
