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
    "`ros2 interface show` shows what ROS has understood; show your own and read it aloud.",
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
    """msg/RobotStatus.msg has the contract's fields, with their types, in their order."""
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
    """srv/CheckTrip.srv has the contract's fields in request and response, with their types, in their order."""
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
    """action/DriveDistance.action has the contract's fields in goal, result and feedback, with types, in order."""
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
@hint("A default stands behind the field's name, without an equals sign: `int32 reserve 20`.")
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
    """The array and the strings that have a bound in the contract have that bound, and the other array has none."""
    _expect_all(workspace, interfaces.Aspect.BOUNDS, 4)


def _expect_all(workspace: Workspace, aspect: interfaces.Aspect, count: int) -> None:
    """Fail the check unless every definition is right in one aspect; `count` elements of the contract have it."""
    wrong = []
    for definition in contract.DEFINITIONS:
        try:
            student_definition = read_definition(workspace, definition)
        except CheckFailed as error:  # such a definition has no right element; the other definitions count
            wrong += [error.message] * sum(1 for _ in interfaces.elements(definition, aspect))
        else:
            differences = interfaces.compare(definition, student_definition)
            wrong += [difference.sentence for difference in differences if difference.aspect is aspect]
    if wrong:
        raise CheckFailed(" ".join([*dict.fromkeys(wrong)][:3]), fraction=round(max(0.0, 1.0 - len(wrong) / count), 2))
