"""The actions on nodes that launch files use."""

from __future__ import annotations

from standin_notice import make_getattr

from .node import Node
from .scope import PushRosNamespace, SetParameter, SetParametersFromFile, SetRemap, SetROSLogDir, SetUseSimTime

PushROSNamespace = PushRosNamespace  # an older name, which Jazzy still has

__all__ = [
    "Node",
    "PushROSNamespace",
    "PushRosNamespace",
    "SetParameter",
    "SetParametersFromFile",
    "SetROSLogDir",
    "SetRemap",
    "SetUseSimTime",
]

_COMPOSABLE = "Composable nodes need C++ components and composition_interfaces, for which there is no wheel"

__getattr__ = make_getattr(
    __name__,
    {
        "ComposableNodeContainer": _COMPOSABLE,
        "LoadComposableNodes": _COMPOSABLE,
    },
)
