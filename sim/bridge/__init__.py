"""The simulator as a ROS 2 robot: `/scan`, `/odom` and `/clock` out, `/cmd_vel` in.

`sim.bridge.messages` holds the pure conversions, `sim.bridge.node` the node, `Bridge` runs it beside a notebook's own
nodes. `import sim.bridge` alone imports no ROS; `Bridge` does. ROS is switched on by the caller, before that.
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sim.bridge.background import Bridge

__all__ = ["Bridge"]


def __getattr__(name: str) -> Any:
    """Import the node, and rclpy with it, only for those who ask for it."""
    if name == "Bridge":
        from importlib import import_module

        return import_module("sim.bridge.background").Bridge
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
