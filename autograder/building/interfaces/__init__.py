"""Message packages: a student's as plain classes for the trusted process, and ROS's tutorials' as real packages.

`load_interfaces` reads a package of a student's workspace. It compiles and imports nothing, and runs no line of the
package's CMake or Python. `prefix.build` turns the texts of one of our packages into a prefix with rosidl's generators.
"""

from autograder.building.interfaces.cache import Cache
from autograder.building.interfaces.loading import load_interfaces

__all__ = ["Cache", "load_interfaces"]
