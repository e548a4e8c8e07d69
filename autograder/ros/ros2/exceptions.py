"""Errors of the `ros2` command; `main` prints their text and exits with 1.

Ros2Error
└── NotCoveredError   the real command can do it, this stand-in cannot
"""

from __future__ import annotations

from autograder.ros.distribution import DISTRIBUTION

HOW_TO_GET_THE_REAL_ONE = f"install it with `make real-launch`, or source a ROS 2 {DISTRIBUTION.title} installation"


class Ros2Error(Exception):
    """The command cannot do what it was asked to; the text says why."""


class NotCoveredError(Ros2Error):
    """The real `ros2` command can do this, the stand-in cannot."""

    def __init__(self, thing: str) -> None:
        super().__init__(
            f"{thing} is not covered by this stand-in; it works with the real ros2cli: {HOW_TO_GET_THE_REAL_ONE}"
        )
