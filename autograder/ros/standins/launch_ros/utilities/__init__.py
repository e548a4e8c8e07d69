"""Helpers for the names and parameters of nodes."""

from __future__ import annotations

from standin_notice import make_getattr

from ._namespaces import is_namespace_absolute, make_namespace_absolute, prefix_namespace
from ._parameters import evaluate_parameters

__all__ = ["evaluate_parameters", "is_namespace_absolute", "make_namespace_absolute", "prefix_namespace"]

__getattr__ = make_getattr(__name__)
