"""Checks of the declared parameters, and of the values with which the node starts."""

from __future__ import annotations

from autograder.checking import Workspace, expect, group, hint
from autograder.checking.probes import parameters
from autograder.checks.ch05_parameters.support import contract
from autograder.checks.ch05_parameters.support.contract import DEFAULTS, NODE, SPECIFICATIONS
from autograder.checks.ch05_parameters.support.robot import Robot, start_error

check = group("declaration")


@check(
    points=1,
    covers=contract.TABLE_ROWS,
    doc=contract.IN_A_CLASS,
)
@hint("Read the sentence above, then the last lines of the traceback below it.")
@hint("Both files have to be saved: run the cells of exercise 1 and of exercise 2.")
def test_starts(robot: Robot) -> None:
    """The package builds, and its node configured_node spins."""
    names = robot.nodes()
    expect(NODE in names, f"{NODE} is not in the graph, which contains {', '.join(names) or 'no node'}.")


@check(
    points=1,
    covers=(*contract.TABLE_ROWS, "no-others"),
    needs=("starts",),
    doc=contract.PARAMETERS,
)
@hint("Call node.declare_parameter(name, default, descriptor) once for each row of the table.")
@hint("The type of a parameter is the type of its default: 20 is an integer, 20.0 is a double.")
def test_table(robot: Robot) -> None:
    """The node declares the six parameters with the types and defaults of the table, and no others."""
    names = robot.parameters.names()
    expect(not (sentence := parameters.missing_sentence(SPECIFICATIONS, names)), sentence)
    expect(not (other_names := sorted(names - set(SPECIFICATIONS))), f"It also declares {', '.join(other_names)}.")
    differences = [
        f"{name} is {parameters.TYPE_NAMES.get(actual, 'an array')} instead of {parameters.TYPE_NAMES[expected]}"
        for name, descriptor in robot.parameters.descriptors(*SPECIFICATIONS).items()
        if (actual := descriptor.type) != (expected := SPECIFICATIONS[name].type)
    ]
    differences = differences or parameters.differences(robot.parameters.values(*DEFAULTS), DEFAULTS)
    expect(not differences, f"{'; '.join(differences)}.")


@check(points=1, covers=("ranges", "robot_name"), needs=("starts",), after=("table",), doc=contract.PARAMETERS)
@hint("floating_point_range=[FloatingPointRange(from_value=..., to_value=...)]: a list with one range in it.")
@hint("An integer needs integer_range=[IntegerRange(...)]; a parameter that is fixed needs read_only=True.")
def test_refuses(robot: Robot) -> None:
    """The node refuses -1 m/s, 0.5 Hz, 51 Hz, 5 m, 101 percent and another robot_name, each with a reason."""
    requests: list[tuple[str, parameters.Value]] = [
        ("max_linear_velocity", -1.0),
        ("control_frequency", 0.5),
        ("control_frequency", 51.0),
        ("safety_distance", 5.0),
        ("slow_distance", 5.0),
        ("battery_threshold", 101),
        ("robot_name", "R2"),
    ]
    declared_names = robot.parameters.names()
    for name, value in requests:
        expect(name in declared_names, f"It does not declare {name}.")
        answer = robot.parameters.change({name: value})
        expect(not answer.accepted, f"It accepted {parameters.value_text(value)} for {name}.")
        expect(bool(answer.reason), f"It refused {parameters.value_text(value)} for {name}, but gave no reason.")


@check(points=1, covers="described", needs=("starts",), after=("table",))
@hint("ParameterDescriptor(description='...', ...): one sentence for each parameter, with its unit.")
def test_described(robot: Robot) -> None:
    """Each parameter has a description. Those of max_linear_velocity and control_frequency name m/s and Hz."""
    descriptions = {
        name: descriptor.description for name, descriptor in robot.parameters.descriptors(*SPECIFICATIONS).items()
    }
    undescribed_names = [name for name, text in descriptions.items() if not text.strip()]
    expect(not undescribed_names, f"There is no description of {', '.join(undescribed_names)}.")
    for name, unit in (("max_linear_velocity", "m/s"), ("control_frequency", "Hz")):
        expect(unit.lower() in descriptions.get(name, "").lower(), f"The description of {name} does not name {unit}.")


@check(points=1, covers="contradictory-start", needs=("starts",), after=("table",))
@hint("After the last declare_parameter, call contradiction with both values, and raise ValueError with its sentence.")
def test_start_refused(workspace: Workspace) -> None:
    """The node does not start with a safety distance of 2.2 m and a slow distance of 2.0 m."""
    error = start_error(workspace, {"safety_distance": 2.2, "slow_distance": 2.0})
    expect(error is not None, "Started with a safety distance of 2.2 m and a slow distance of 2.0 m, the node runs.")
