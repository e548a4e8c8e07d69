"""The student's interfaces as classes of plain values, made of their texts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from autograder.checking import Workspace, load_interfaces
from autograder.checks.ch03_interfaces.support.contract import INTERFACES


@dataclass(frozen=True)
class Types:
    """The three classes."""

    robot_status: Any
    check_trip: Any
    drive_distance: Any


def load_types(workspace: Workspace) -> Types:
    """Read the student's interfaces.

    Raises:
        StudentError: a definition is missing or wrong.
    """
    found = load_interfaces(workspace, INTERFACES)
    return Types(found.msg.RobotStatus, found.srv.CheckTrip, found.action.DriveDistance)
