"""Checks of the declared parameters: their names, types, defaults, limits and descriptions."""

from __future__ import annotations

import random

from rcl_interfaces.msg import ParameterDescriptor

from autograder.checking import expect, group, hint
from autograder.checking.probes import parameters
from autograder.checks.ch05_parameters.support import contract
from autograder.checks.ch05_parameters.support.contract import DEFAULTS, NODE, SPECIFICATIONS, Specification
from autograder.checks.ch05_parameters.support.robot import Robot

check = group("declaration")
UNIT_SPELLINGS = {
    "m": {"m", "metre", "metres", "meter", "meters"},
    "s": {"s", "second", "seconds"},
    "Hz": {"hz", "hertz", "s", "second"},
    "percent": {"percent", "percentage"},
}
DURATION_WORDS = {"time", "period", "interval"}
RATE_WORDS = {"hz", "hertz", "per", "a", "each", "every"}


@check(
    points=1,
    covers=contract.TABLE_ROWS,
    doc=contract.IN_A_CLASS,
)
@hint("Read the sentence above, then the last lines of the traceback below it.")
@hint("python -m my_robot_package.nodes.configured_node, run in ws/src/my_robot_package, shows the same error.")
def test_starts(robot: Robot) -> None:
    """The node configured_node starts and spins."""
    names = robot.nodes()
    expect(NODE in names, f"{NODE} is not in the graph, which contains {', '.join(names) or 'no node'}.")


@check(
    points=2,
    covers=contract.TABLE_ROWS,
    needs=("starts",),
    doc=contract.PARAMETERS,
)
@hint("Call node.declare_parameter(name, default, descriptor) once for each row of the table.")
@hint("Compare the names letter by letter with ros2 param list /configured_node.")
def test_names(robot: Robot) -> None:
    """The node declares the six parameters of the table."""
    names = robot.parameters.names()
    missing = parameters.near_misses(SPECIFICATIONS, names)
    expect(not missing, parameters.missing_sentence(SPECIFICATIONS, names), fraction=_fraction(len(missing)))


@check(
    points=2,
    covers=contract.TABLE_ROWS,
    needs=("starts",),
    after=("names",),
    doc=contract.PARAMETERS,
)
@hint("The type of a parameter is the type of its default: 20 is an integer, 20.0 is a double.")
@hint("With a default of None, a parameter has no type.")
def test_types(robot: Robot) -> None:
    """Each parameter has the type in the table."""
    differences = [
        f"{name} is {_type_text(robot.descriptors.get(name))} instead of {parameters.TYPE_NAMES[spec.type]}"
        for name, spec in SPECIFICATIONS.items()
        if name not in robot.descriptors or robot.descriptors[name].type != spec.type
    ]
    expect(not differences, f"{'; '.join(differences)}.", fraction=_fraction(len(differences)))


@check(
    points=1,
    covers=contract.TABLE_ROWS,
    needs=("starts",),
    after=("names", "types"),
)
@hint("The default is declare_parameter's second argument.")
def test_defaults(robot: Robot) -> None:
    """Started without values, the node has the defaults in the table."""
    # Another check tests the types.
    differences = parameters.differences(parameters.as_declared(robot.initial, DEFAULTS), DEFAULTS)
    expect(not differences, f"{'; '.join(differences)}.", fraction=_fraction(len(differences)))


@check(points=1, covers="described", needs=("starts",), after=("names",))
@hint("ParameterDescriptor(description='...') is declare_parameter's third argument.")
def test_descriptions(robot: Robot) -> None:
    """Each parameter has a description, which names the unit if there is one."""
    descriptions = {name: descriptor.description for name, descriptor in robot.descriptors.items()}
    unclear_names = [
        name for name, spec in SPECIFICATIONS.items() if not _is_description(descriptions.get(name, ""), spec.unit)
    ]
    unclear_texts = [f"{name} ({parameters.value_text(descriptions.get(name))})" for name in unclear_names]
    expect(
        not unclear_names,
        f"The description is missing, or does not name the unit: {', '.join(unclear_texts)}.",
        fraction=_fraction(len(unclear_names)),
    )


@check(
    points=3,
    covers=(
        "ranges",
        "max_linear_velocity",
        "safety_distance",
        "slow_distance",
        "control_frequency",
        "battery_threshold",
    ),
    needs=("starts",),
    after=("names",),
    doc=contract.PARAMETERS,
)
@hint("floating_point_range=[FloatingPointRange(from_value=..., to_value=...)]: a list with one range in it.")
@hint("An integer has integer_range=[IntegerRange(...)]; a floating_point_range does not limit it.")
def test_ranges(robot: Robot, draw: random.Random) -> None:
    """Values outside the limits in the table are refused, and the descriptors contain these limits."""
    limited_specs = {name: spec for name, spec in SPECIFICATIONS.items() if spec.low is not None}
    faults = {
        name: fault
        for name, spec in limited_specs.items()
        if (fault := _range_fault(spec, robot.descriptors.get(name)))
    }
    for name, spec in limited_specs.items():
        for value in _values_outside(spec, draw):
            answer = robot.change({name: value})
            if answer.accepted or (not answer.reason and name not in faults):
                text = parameters.value_text(value)
                faults[name] = f"it accepted {text}" if answer.accepted else f"it refused {text} without a reason"
    message = "; ".join(f"{name}: {fault}" for name, fault in faults.items())
    expect(not faults, f"{message}.", fraction=round(0.8 * (1 - len(faults) / len(limited_specs)), 2))


@check(points=1, covers="robot_name", needs=("starts",), after=("names",))
@hint("read_only=True in the descriptor of robot_name; the others can be changed.")
def test_read_only(robot: Robot) -> None:
    """The parameter robot_name is fixed once the node has started."""
    before = robot.parameters.values("robot_name")
    answer = robot.parameters.change({"robot_name": "Somebody"})
    expect(not answer.accepted, "While the node was running, it accepted another robot_name.")
    expect(robot.parameters.values("robot_name") == before, "It refused another robot_name, but changed it.")
    read_only_names = [name for name, descriptor in robot.descriptors.items() if descriptor.read_only]
    message = (
        f"The read-only parameters are {', '.join(read_only_names) or 'none'}; only robot_name should be read-only."
    )
    expect(read_only_names == ["robot_name"], message)


@check(
    points=1,
    covers=contract.TABLE_ROWS,
    needs=("starts",),
    after=("names", "types"),
)
@hint("dynamic_typing in a descriptor allows values of any type: leave it out.")
def test_typed(robot: Robot) -> None:
    """A value of another type is refused."""
    accepted_values = [
        f"{parameters.value_text(value)} for {name}"
        for name, value in (
            ("slow_distance", 2),
            ("safety_distance", 0),  # below any slow distance, so that only the type is wrong
            ("max_linear_velocity", 1),
            ("battery_threshold", 20.0),
            ("control_frequency", "10"),
        )
        if name in robot.initial and robot.parameters.change({name: value}).accepted
    ]
    expect(not accepted_values, f"It accepted {', '.join(accepted_values)}.", fraction=_fraction(len(accepted_values)))
    missing = parameters.near_misses(SPECIFICATIONS, robot.initial)
    expect(not missing, parameters.missing_sentence(SPECIFICATIONS, robot.initial), fraction=_fraction(len(missing)))


@check(points=1, covers="no-others", needs=("starts",), after=("names",))
@hint("The node uses every name that it declares: declare only the names in the table.")
@hint("With allow_undeclared_parameters, every misspelt name is accepted: leave it out.")
def test_no_others(robot: Robot, draw: random.Random) -> None:
    """The node declares no other names, and refuses a name that was not declared."""
    names = robot.parameters.names()
    expect(bool(names & set(SPECIFICATIONS)), "It declares none of the parameters of the table.")
    other_names = sorted(names - set(SPECIFICATIONS))
    expect(not other_names, f"It also declares {parameters.shortened(', '.join(other_names))}.")
    name = draw.choice(("safty_distance", "max_linear_velocty", "control_freqency"))
    expect(not robot.parameters.change({name: 1.0}).accepted, f"It accepted 1.0 for {name}, which it does not declare.")


def _fraction(wrong_count: int) -> float:
    """Return the fraction of the points if this many of the six parameters are wrong."""
    return round(0.8 * max(0.0, 1 - wrong_count / len(SPECIFICATIONS)), 2)


def _is_description(text: str, unit: str) -> bool:
    """Return whether a description is not empty and names the unit, abbreviated or spelt out."""
    words = {word.strip(".,;:()[]") for word in text.lower().replace("/", " ").replace("%", " percent ").split()}
    if unit == "m" and words & UNIT_SPELLINGS["s"]:
        return False  # m/s is a speed, not a distance
    if unit == "Hz" and words & DURATION_WORDS and "/" not in text and not words & RATE_WORDS:
        return False  # a period, not a rate
    return bool(words) and all(words & UNIT_SPELLINGS[part] for part in unit.split("/") if part)


def _type_text(descriptor: ParameterDescriptor | None) -> str:
    return "not declared" if descriptor is None else parameters.TYPE_NAMES.get(descriptor.type, "an array")


def _range_fault(spec: Specification, descriptor: ParameterDescriptor | None) -> str:
    if descriptor is None:
        return "it is not declared"
    ranges = [*descriptor.floating_point_range, *descriptor.integer_range]
    if not ranges:
        return "it has no range"
    low, high = float(ranges[0].from_value), float(ranges[0].to_value)
    if abs(low - float(spec.low or 0)) > 1e-9 or abs(high - float(spec.high or 0)) > 1e-9:
        return f"its range is {low:g} to {high:g} instead of {spec.low:g} to {spec.high:g}"
    max_step = 1 if isinstance(spec.default, int) else 0
    return f"its range has steps of {ranges[0].step:g}" if ranges[0].step > max_step else ""


def _values_outside(spec: Specification, draw: random.Random) -> tuple[parameters.Value, parameters.Value]:
    assert spec.low is not None, "the parameter has no limits"
    assert spec.high is not None, "the parameter has no limits"
    if isinstance(spec.default, int):
        return int(spec.low) - draw.randrange(1, 9), int(spec.high) + draw.randrange(1, 9)
    return spec.low - draw.uniform(0.05, 2.0), spec.high + draw.uniform(0.05, 2.0)
