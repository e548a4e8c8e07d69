"""Descriptions of parameters and parameter files; descriptions of composable nodes are not covered."""

from __future__ import annotations

from standin_notice import make_getattr

from .parameter_descriptions import Parameter, ParameterFile, ParameterValue

__all__ = ["Parameter", "ParameterFile", "ParameterValue"]

_COMPOSABLE = "Composable nodes need C++ components and composition_interfaces, for which there is no wheel"

__getattr__ = make_getattr(__name__, {"ComposableNode": _COMPOSABLE, "ComposableLifecycleNode": _COMPOSABLE})
