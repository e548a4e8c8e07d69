"""The events of nodes with a life cycle, and matchers of nodes."""

from __future__ import annotations

from standin_notice import guard

from . import lifecycle, matchers

__all__ = ["lifecycle", "matchers"]

__getattr__ = guard(__name__)
