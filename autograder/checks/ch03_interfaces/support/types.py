"""The student's interfaces as classes of plain values, generated from their definitions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from autograder.checking import Workspace, load_interfaces
from autograder.checks.ch03_interfaces.support.contract import INTERFACES


@dataclass(frozen=True)
class Types:
    """The classes of the message, the service and the action."""

    robot_status: Any
    check_trip: Any
    drive_distance: Any


def load_types(workspace: Workspace) -> Types:
    """Read the student's interfaces.

    Raises:
        StudentError: a definition is missing or wrong.
    """
    interfaces = load_interfaces(workspace, INTERFACES)
    return Types(interfaces.msg.RobotStatus, interfaces.srv.CheckTrip, interfaces.action.DriveDistance)
