"""The actions on nodes that launch files use."""

from __future__ import annotations

from standin_notice import guard

from .node import Node
from .ros_timer import ROSTimer, RosTimer
from .scope import PushRosNamespace, SetParameter, SetParametersFromFile, SetRemap, SetROSLogDir, SetUseSimTime

PushROSNamespace = PushRosNamespace  # the older spelling, which Jazzy still has

__all__ = [
    "Node",
    "PushROSNamespace",
    "PushRosNamespace",
    "ROSTimer",
    "RosTimer",
    "SetParameter",
    "SetParametersFromFile",
    "SetROSLogDir",
    "SetRemap",
    "SetUseSimTime",
]

_LIFECYCLE = "Lifecycle nodes need the launch events of lifecycle_msgs, which have no stand-in"
_COMPOSABLE = "Composable nodes need C++ components and composition_interfaces, for which there is no wheel"

__getattr__ = guard(
    __name__,
    {
        "LifecycleNode": _LIFECYCLE,
        "LifecycleTransition": _LIFECYCLE,
        "ComposableNodeContainer": _COMPOSABLE,
        "LoadComposableNodes": _COMPOSABLE,
    },
)
