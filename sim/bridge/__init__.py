"""The simulator as a ROS 2 robot, which publishes `/scan`, `/odom` and `/clock` and subscribes to `/cmd_vel`.

`sim.bridge.messages` converts messages, `sim.bridge.node` contains the node, and `Bridge` runs it beside the nodes of a
notebook. `import sim.bridge` does not import ROS, but `Bridge` does: the caller has to make it importable first.
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sim.bridge.background import Bridge

__all__ = ["Bridge"]


def __getattr__(name: str) -> Any:
    """Import the node, and rclpy with it, only when `Bridge` is used."""
    if name == "Bridge":
        from importlib import import_module

        return import_module("sim.bridge.background").Bridge
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
