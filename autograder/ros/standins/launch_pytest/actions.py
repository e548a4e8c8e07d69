"""The action with which a launch description says that the test may begin."""

from __future__ import annotations

from launch_testing.actions import ReadyToTest
from standin_notice import make_getattr

__all__ = ["ReadyToTest"]

__getattr__ = make_getattr(__name__)
