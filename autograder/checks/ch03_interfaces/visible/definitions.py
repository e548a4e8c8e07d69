"""Checks of the definitions and of their build."""

from __future__ import annotations

from collections.abc import Mapping

from autograder.checking import OK, Diagnosis, StudentError, Workspace, group, hint
from autograder.checking.probes import interfaces
from autograder.checks.ch03_interfaces.support import contract
from autograder.checks.ch03_interfaces.support.reading import expect_definition

check = group("definitions")
ASPECTS = tuple(interfaces.Aspect)
TABLE_HINTS = (
    "Compare your file with the exercise's table, line by line.",
    "A field is `type name`, a default follows the name, and a constant is `type NAME = value`.",
)


@check(
    points=1,
    covers=(
        "names-and-order",
        "battery-unknown",
        "status-header",
        "status-name",
        "status-level",
        "status-charging",
        "status-joints",
    ),
    doc=contract.DEFINE,
)
@hint(*TABLE_HINTS)
def test_robot_status(workspace: Workspace) -> None:
    """msg/RobotStatus.msg matches the table."""
    expect_definition(workspace, contract.ROBOT_STATUS, *ASPECTS)


@check(
    points=1,
    covers=(
        "names-and-order",
        "metres-per-percent",
        "trip-legs",
        "trip-reserve",
        "trip-possible-field",
        "trip-at-end",
        "trip-reason-field",
    ),
    doc=contract.LANGUAGE,
)
@hint(*TABLE_HINTS)
def test_check_trip(workspace: Workspace) -> None:
    """srv/CheckTrip.srv matches the table."""
    expect_definition(workspace, contract.CHECK_TRIP, *ASPECTS)


@check(
    points=1,
    covers=(
        "names-and-order",
        "goal-constants",
        "goal-distance",
        "goal-speed",
        "result-driven",
        "result-reason",
        "feedback-fields",
    ),
    doc=contract.LANGUAGE,
)
@hint(*TABLE_HINTS)
def test_drive_distance(workspace: Workspace) -> None:
    """action/DriveDistance.action matches the table."""
    expect_definition(workspace, contract.DRIVE_DISTANCE, *ASPECTS)


@check(points=1, covers="interfaces-manifest", doc=contract.DEFINE)
@hint("Read the first error above; `colcon build` in a terminal shows the same.")
@hint("rosidl_generate_interfaces in CMakeLists.txt must name each file, and std_msgs after DEPENDENCIES.")
@hint("package.xml must contain the build type ament_cmake in <export>.")
def test_builds(builds: Mapping[str, Diagnosis]) -> None:
    """Colcon builds both packages."""
    for diagnosis in builds.values():
        if diagnosis is not OK:
            raise StudentError(diagnosis)
