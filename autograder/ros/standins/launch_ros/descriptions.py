"""Descriptions of parameters and parameter files; those of composable nodes are not covered."""

from __future__ import annotations

from standin_notice import guard

from .parameter_descriptions import Parameter, ParameterFile, ParameterValue

__all__ = ["Parameter", "ParameterFile", "ParameterValue"]

_COMPOSABLE = "Composable nodes need C++ components and composition_interfaces, for which there is no wheel"

__getattr__ = guard(__name__, {"ComposableNode": _COMPOSABLE, "ComposableLifecycleNode": _COMPOSABLE})
