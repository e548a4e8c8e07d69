"""The action of a launch description that lets the tests start."""

from __future__ import annotations

from launch_testing.actions import ReadyToTest
from standin_notice import make_getattr

__all__ = ["ReadyToTest"]

__getattr__ = make_getattr(__name__)
