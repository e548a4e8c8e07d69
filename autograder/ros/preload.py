"""What nearly every ROS program needs: for what forks such programs.

The libraries are loaded. No module comes with one, but many are READY: a program that lacks an import still lacks it
(`zygote_host/ready.py`). The generator of messages, which a message's module imports if it can, is barred, as the
programs' hosts do.
"""

from __future__ import annotations

import ctypes
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

READY = (
    "importlib.metadata",  # by which a program's script finds it
    *(f"rclpy.{name}" for name in ("node", "executors", "action", "parameter", "qos", "callback_groups", "duration")),
    *(f"rclpy.{name}" for name in ("time", "logging", "clock", "parameter_client", "qos_event", "event_handler")),
    *(f"{package}.{kind}" for package in PACKAGES for kind in ("msg", "srv", "action")),
)


def warm() -> None:
    """Let the types of all messages that are there find their libraries, as a node's first use of each does."""
    modules = (module for name, module in list(sys.modules.items()) if name.endswith((".msg", ".srv", ".action")))
    for kind in {type(value) for module in modules for value in vars(module).values()}:
        if hasattr(kind, "__import_type_support__"):
            kind.__import_type_support__()
