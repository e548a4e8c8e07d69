"""Starting single processes in tests: not covered."""

from __future__ import annotations

from standin_notice import guard

__getattr__ = guard(__name__)
