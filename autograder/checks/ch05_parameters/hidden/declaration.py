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
@hint("python -m my_robot_package.nodes.configured_node, run in ws/src/my_robot_package, shows the same.")
def test_starts(robot: Robot) -> None:
    """The node configured_node starts and spins."""
    names = robot.nodes()
    expect(NODE in names, f"The graph holds {', '.join(names) or 'no node'}, but no {NODE}.")


@check(
    points=2,
    covers=contract.TABLE_ROWS,
    needs=("starts",),
    doc=contract.PARAMETERS,
)
@hint("One node.declare_parameter(name, default, descriptor) for each line of the table.")
@hint("Compare the names letter by letter with ros2 param list /configured_node.")
def test_names(robot: Robot) -> None:
    """It declares the six parameters of the table."""
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
@hint("A default of None leaves the type open.")
def test_types(robot: Robot) -> None:
    """Each has the type of the table."""
    wrong = [
        f"{name} is {_type_text(robot.descriptors.get(name))} instead of {parameters.TYPE_NAMES[spec.type]}"
        for name, spec in SPECIFICATIONS.items()
        if name not in robot.descriptors or robot.descriptors[name].type != spec.type
    ]
    expect(not wrong, f"{'; '.join(wrong)}.", fraction=_fraction(len(wrong)))


@check(
    points=1,
    covers=contract.TABLE_ROWS,
    needs=("starts",),
    after=("names", "types"),
)
@hint("The default is declare_parameter's second argument.")
def test_defaults(robot: Robot) -> None:
    """Started without any values, it has the defaults of the table."""
    # Another check tests the types.
    wrong = parameters.differences(parameters.as_declared(robot.initial, DEFAULTS), DEFAULTS)
    expect(not wrong, f"{'; '.join(wrong)}.", fraction=_fraction(len(wrong)))


@check(points=1, covers="described", needs=("starts",), after=("names",))
@hint("ParameterDescriptor(description='...') is declare_parameter's third argument.")
def test_descriptions(robot: Robot) -> None:
    """Each has a description, which names the unit where there is one."""
    descriptions = {name: descriptor.description for name, descriptor in robot.descriptors.items()}
    poor_names = [
        name for name, spec in SPECIFICATIONS.items() if not _is_description(descriptions.get(name, ""), spec.unit)
    ]
    poor_texts = [f"{name} ({parameters.value_text(descriptions.get(name))})" for name in poor_names]
    expect(
        not poor_names,
        f"The description is missing, or names no unit: {', '.join(poor_texts)}.",
        fraction=_fraction(len(poor_names)),
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
@hint("An integer has integer_range=[IntegerRange(...)]; a floating_point_range does not guard it.")
def test_ranges(robot: Robot, draw: random.Random) -> None:
    """Values outside the limits of the table are refused, and the descriptors say the limits."""
    limited_specs = {name: spec for name, spec in SPECIFICATIONS.items() if spec.low is not None}
    wrong = {
        name: fault
        for name, spec in limited_specs.items()
        if (fault := _range_fault(spec, robot.descriptors.get(name)))
    }
    for name, spec in limited_specs.items():
        for value in _values_outside(spec, draw):
            answer = robot.change({name: value})
            if answer.accepted or (not answer.reason and name not in wrong):
                text = parameters.value_text(value)
                wrong[name] = f"it took {text}" if answer.accepted else f"it refused {text} without a reason"
    faults = "; ".join(f"{name}: {fault}" for name, fault in wrong.items())
    expect(not wrong, f"{faults}.", fraction=round(0.8 * (1 - len(wrong) / len(limited_specs)), 2))


@check(points=1, covers="robot_name", needs=("starts",), after=("names",))
@hint("read_only=True in the descriptor of robot_name; the others can be changed.")
def test_read_only(robot: Robot) -> None:
    """The robot's name is fixed once it has started."""
    before = robot.parameters.values("robot_name")
    answer = robot.parameters.change({"robot_name": "Somebody"})
    expect(not answer.accepted, "Asked to call itself Somebody, the running node did.")
    expect(robot.parameters.values("robot_name") == before, "It refused another name, and changed it all the same.")
    read_only = [name for name, descriptor in robot.descriptors.items() if descriptor.read_only]
    expect(read_only == ["robot_name"], f"Its descriptors say read-only of: {', '.join(read_only) or 'nothing'}.")


@check(
    points=1,
    covers=contract.TABLE_ROWS,
    needs=("starts",),
    after=("names", "types"),
)
@hint("dynamic_typing in a descriptor lets a value of any type in: leave it out.")
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
    expect(not accepted_values, f"It took {', '.join(accepted_values)}.", fraction=_fraction(len(accepted_values)))
    missing = parameters.near_misses(SPECIFICATIONS, robot.initial)
    expect(not missing, parameters.missing_sentence(SPECIFICATIONS, robot.initial), fraction=_fraction(len(missing)))


@check(points=1, covers="no-others", needs=("starts",), after=("names",))
@hint("Every declared name has work to do: what is not in the table is not declared.")
@hint("allow_undeclared_parameters lets every misspelling in: leave it out.")
def test_no_others(robot: Robot, draw: random.Random) -> None:
    """It declares nothing else, and refuses a name that was not declared."""
    names = robot.parameters.names()
    expect(bool(names & set(SPECIFICATIONS)), "It declares none of the parameters of the table.")
    others = sorted(names - set(SPECIFICATIONS))
    expect(not others, f"It also declares {parameters.shortened(', '.join(others))}.")
    name = draw.choice(("safty_distance", "max_linear_velocty", "control_freqency"))
    expect(not robot.parameters.change({name: 1.0}).accepted, f"It took 1.0 for {name}, a name that nobody declared.")


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
        return "no range"
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
