"""Tools that start single processes in tests, which are not covered."""

from __future__ import annotations

from standin_notice import make_getattr

__getattr__ = make_getattr(__name__)
