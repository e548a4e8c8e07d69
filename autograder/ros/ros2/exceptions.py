"""Errors of the `ros2` command. `main` prints their message and exits with 1.

Ros2Error
└── NotCoveredError   only the real command has this feature
"""

from __future__ import annotations

from autograder.ros.distribution import DISTRIBUTION

INSTALL_HINT = f"install it with `make real-launch`, or source a ROS 2 {DISTRIBUTION.title} installation"


class Ros2Error(Exception):
    """The command failed. The message states the reason."""


class NotCoveredError(Ros2Error):
    """The real `ros2` command has this feature, but the stand-in does not."""

    def __init__(self, feature: str) -> None:
        super().__init__(f"{feature} is not covered by this stand-in; it works with the real ros2cli: {INSTALL_HINT}")
