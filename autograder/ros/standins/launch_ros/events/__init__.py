"""The events of nodes with a life cycle, and matchers of nodes."""

from __future__ import annotations

from standin_notice import guard

from . import lifecycle, matchers
from .matchers import matches_node_name

__all__ = ["lifecycle", "matchers", "matches_node_name"]

__getattr__ = guard(__name__)
