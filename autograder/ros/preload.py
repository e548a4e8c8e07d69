"""Loads the libraries that nearly every ROS program needs, for what forks such programs.

No module of ROS comes with a library: a program that lacks an import still lacks it. Only what the script that starts
every program imports first of all is imported here, too: `importlib.metadata`, by which it finds the program. The generator of messages, which a
message's module imports if it can, is barred, as the programs' hosts do.
"""

from __future__ import annotations

import ctypes
import importlib.metadata
import sys
from contextlib import suppress

PACKAGES = (
    *("rcl_interfaces", "type_description_interfaces", "action_msgs", "rosgraph_msgs"),
    *("std_msgs", "std_srvs", "geometry_msgs", "sensor_msgs", "nav_msgs"),
)
KINDS = ("generator_py", "typesupport_c", "typesupport_fastrtps_c", "typesupport_introspection_c")

sys.modules.setdefault("rosidl_generator_py.generate_py_impl", None)  # type: ignore[arg-type]
for name in ("rmw_fastrtps_cpp", *(f"{package}__rosidl_{kind}" for package in PACKAGES for kind in KINDS)):
    with suppress(OSError):  # a ROS that does without one of them is as good
        ctypes.CDLL(f"lib{name}.so")
