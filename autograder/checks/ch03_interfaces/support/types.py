"""The student's interfaces in the trusted process, rebuilt from their texts by the grader's own means."""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import Any

from autograder.checks.ch03_interfaces.support.contract import INTERFACES
from autograder.harness import Workspace
from autograder.interfaces import load_from


@dataclass(frozen=True)
class Types:
    """The three generated classes."""

    robot_status: Any
    check_trip: Any
    drive_distance: Any


def load_types(workspace: Workspace) -> Types:
    """Build and load the student's interfaces.

    Raises:
        StudentError: a definition is missing or wrong.
    """
    load_from(workspace, INTERFACES)
    return Types(
        importlib.import_module(f"{INTERFACES}.msg").RobotStatus,
        importlib.import_module(f"{INTERFACES}.srv").CheckTrip,
        importlib.import_module(f"{INTERFACES}.action").DriveDistance,
    )
