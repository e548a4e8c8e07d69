"""Matchers that select a node by its name."""

from __future__ import annotations

from standin_notice import guard

from .matches_node_name import matches_node_name

__all__ = ["matches_node_name"]

__getattr__ = guard(__name__)
