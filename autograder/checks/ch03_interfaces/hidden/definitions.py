"""Checks of the three definitions: first names, types and order, then constants, defaults and bounds."""

from __future__ import annotations

from autograder.checking import CheckFailed, Workspace, group, hint
from autograder.checking.probes import interfaces
from autograder.checks.ch03_interfaces.support import contract
from autograder.checks.ch03_interfaces.support.reading import expect_definition, read_definition

check = group("definitions")
READABLE_CHECK = ("readable",)
FIELDS = (interfaces.Aspect.FIELDS, interfaces.Aspect.TYPES)
TABLE_HINTS = (
    "Compare your file with the exercise's table, line by line: name, type, order.",
    "`ros2 interface show` shows how ROS reads a definition. Show your own, and compare it with the table.",
)


@check(points=1, covers="names-and-order", doc=contract.DEFINE)
@hint("The files are msg/RobotStatus.msg, srv/CheckTrip.srv and action/DriveDistance.action in my_robot_interfaces.")
@hint("`colcon build` names the line that it cannot read.")
def test_readable(workspace: Workspace) -> None:
    """The three definitions are in my_robot_interfaces, and ROS can read them."""
    for definition in contract.DEFINITIONS:
        read_definition(workspace, definition)


@check(
    points=2,
    covers=(
        "names-and-order",
        "battery-unknown",
        "status-header",
        "status-name",
        "status-level",
        "status-charging",
        "status-joints",
    ),
    after=READABLE_CHECK,
    doc=contract.DEFINE,
)
@hint(*TABLE_HINTS)
def test_robot_status(workspace: Workspace) -> None:
    """msg/RobotStatus.msg has the contract's fields, types and order."""
    expect_definition(workspace, contract.ROBOT_STATUS, *FIELDS)


@check(
    points=2,
    covers=(
        "names-and-order",
        "metres-per-percent",
        "trip-legs",
        "trip-reserve",
        "trip-possible-field",
        "trip-at-end",
        "trip-reason-field",
    ),
    after=READABLE_CHECK,
    doc=contract.LANGUAGE,
)
@hint(*TABLE_HINTS)
def test_check_trip(workspace: Workspace) -> None:
    """srv/CheckTrip.srv has the contract's fields, types and order in request and response."""
    expect_definition(workspace, contract.CHECK_TRIP, *FIELDS)


@check(
    points=2,
    covers=(
        "names-and-order",
        "goal-constants",
        "goal-distance",
        "goal-speed",
        "result-driven",
        "result-reason",
        "feedback-fields",
    ),
    after=READABLE_CHECK,
    doc=contract.LANGUAGE,
)
@hint(*TABLE_HINTS)
def test_drive_distance(workspace: Workspace) -> None:
    """action/DriveDistance.action has the contract's fields, types and order in goal, result and feedback."""
    expect_definition(workspace, contract.DRIVE_DISTANCE, *FIELDS)


@check(
    points=1,
    covers=("battery-unknown", "metres-per-percent", "goal-constants"),
    after=READABLE_CHECK,
    doc=contract.LANGUAGE,
)
@hint("A constant is written `type NAME = value`, with an equals sign and in capitals; it is never sent.")
def test_constants(workspace: Workspace) -> None:
    """The four constants of the definitions have the contract's names, types and values."""
    _expect_all(workspace, interfaces.Aspect.CONSTANTS, 4)


@check(
    points=1,
    covers=("status-level", "trip-reserve", "trip-at-end", "goal-speed"),
    after=READABLE_CHECK,
    doc=contract.LANGUAGE,
)
@hint("A default follows the field's name, without an equals sign: `int32 reserve 20`.")
def test_defaults(workspace: Workspace) -> None:
    """The four defaults of the definitions have the contract's values."""
    _expect_all(workspace, interfaces.Aspect.DEFAULTS, 4)


@check(
    points=1,
    covers=("trip-legs", "trip-reason-field", "result-reason", "status-joints"),
    after=READABLE_CHECK,
    doc=contract.LANGUAGE,
)
@hint("`float64[<=8] legs` holds at most eight, `float64[8] legs` exactly eight; `string<=80` at most 80 characters.")
def test_bounds(workspace: Workspace) -> None:
    """The fields legs and reason have the contract's bounds, and joint_positions has no bound."""
    _expect_all(workspace, interfaces.Aspect.BOUNDS, 4)


def _expect_all(workspace: Workspace, aspect: interfaces.Aspect, count: int) -> None:
    """Fail the check unless each definition matches the contract in one aspect, which `count` of its elements have."""
    problems = []
    for definition in contract.DEFINITIONS:
        try:
            student_definition = read_definition(workspace, definition)
        except CheckFailed as error:  # all elements of such a definition are wrong; the other definitions count
            problems += [error.message] * sum(1 for _ in interfaces.elements(definition, aspect))
        else:
            differences = interfaces.compare(definition, student_definition)
            problems += [difference.sentence for difference in differences if difference.aspect is aspect]
    if problems:
        fraction = round(max(0.0, 1.0 - len(problems) / count), 2)
        raise CheckFailed(" ".join([*dict.fromkeys(problems)][:3]), fraction=fraction)
