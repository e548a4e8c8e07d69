"""What the node declares: names, types, defaults, limits, descriptions, and nothing else."""

from __future__ import annotations

import random

from rcl_interfaces.msg import ParameterDescriptor

from autograder.checking import expect, group, hint
from autograder.checking.probes import parameters
from autograder.checks.ch05_parameters.support import contract
from autograder.checks.ch05_parameters.support.contract import DEFAULTS, NODE, WANTED, Wanted
from autograder.checks.ch05_parameters.support.robot import Robot

check = group("declaration")
SPELT = {
    "m": {"m", "metre", "metres", "meter", "meters"},
    "s": {"s", "second", "seconds"},
    "Hz": {"hz", "hertz", "s", "second"},
    "percent": {"percent", "percentage"},
}
SPANS = {"time", "period", "interval"}
PER = {"hz", "hertz", "per", "a", "each", "every"}


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
    found = robot.parameters.names()
    missing = parameters.near_misses(WANTED, found)
    expect(not missing, parameters.missing_sentence(WANTED, found), fraction=_share(len(missing)))


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
        f"{name} is {_type_text(robot.descriptors.get(name))} instead of {parameters.TYPES[wanted.type]}"
        for name, wanted in WANTED.items()
        if name not in robot.descriptors or robot.descriptors[name].type != wanted.type
    ]
    expect(not wrong, f"{'; '.join(wrong)}.", fraction=_share(len(wrong)))


@check(
    points=1,
    covers=contract.TABLE_ROWS,
    needs=("starts",),
    after=("names", "types"),
)
@hint("The default is declare_parameter's second argument.")
def test_defaults(robot: Robot) -> None:
    """Started without any values, it has the defaults of the table."""
    wrong = parameters.differences(
        parameters.as_declared(robot.initial, DEFAULTS), DEFAULTS
    )  # another check judges the types
    expect(not wrong, f"{'; '.join(wrong)}.", fraction=_share(len(wrong)))


@check(points=1, covers="described", needs=("starts",), after=("names",))
@hint("ParameterDescriptor(description='...') is declare_parameter's third argument.")
def test_descriptions(robot: Robot) -> None:
    """Each has a description, which names the unit where there is one."""
    described = {name: found.description for name, found in robot.descriptors.items()}
    poor = [name for name, wanted in WANTED.items() if not _is_description(described.get(name, ""), wanted.unit)]
    named = [f"{name} ({parameters.value_text(described.get(name))})" for name in poor]
    expect(not poor, f"The description is missing, or names no unit: {', '.join(named)}.", fraction=_share(len(poor)))


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
    limited = {name: wanted for name, wanted in WANTED.items() if wanted.low is not None}
    wrong = {
        name: why for name, wanted in limited.items() if (why := _range_fault(wanted, robot.descriptors.get(name)))
    }
    for name, wanted in limited.items():
        for value in _outside(wanted, draw):
            answer = robot.change({name: value})
            if answer.accepted or (not answer.reason and name not in wrong):
                shown = parameters.value_text(value)
                wrong[name] = f"it took {shown}" if answer.accepted else f"it refused {shown} without a reason"
    told = "; ".join(f"{name}: {why}" for name, why in wrong.items())
    expect(not wrong, f"{told}.", fraction=round(0.8 * (1 - len(wrong) / len(limited)), 2))


@check(points=1, covers="robot_name", needs=("starts",), after=("names",))
@hint("read_only=True in the descriptor of robot_name; the others can be changed.")
def test_read_only(robot: Robot) -> None:
    """The robot's name is fixed once it has started."""
    before = robot.parameters.values("robot_name")
    answer = robot.parameters.change({"robot_name": "Somebody"})
    expect(not answer.accepted, "Asked to call itself Somebody, the running node did.")
    expect(robot.parameters.values("robot_name") == before, "It refused another name, and changed it all the same.")
    fixed = [name for name, found in robot.descriptors.items() if found.read_only]
    expect(fixed == ["robot_name"], f"Its descriptors say read-only of: {', '.join(fixed) or 'nothing'}.")


@check(
    points=1,
    covers=contract.TABLE_ROWS,
    needs=("starts",),
    after=("names", "types"),
)
@hint("dynamic_typing in a descriptor lets a value of any type in: leave it out.")
def test_typed(robot: Robot) -> None:
    """A value of another type is refused."""
    taken = [
        f"{parameters.value_text(value)} for {name}"
        for name, value in (
            ("slow_distance", 2),
            ("safety_distance", 0),  # fits any slow distance: the type alone is wrong
            ("max_linear_velocity", 1),
            ("battery_threshold", 20.0),
            ("control_frequency", "10"),
        )
        if name in robot.initial and robot.parameters.change({name: value}).accepted
    ]
    expect(not taken, f"It took {', '.join(taken)}.", fraction=_share(len(taken)))
    absent = parameters.near_misses(WANTED, robot.initial)
    expect(not absent, parameters.missing_sentence(WANTED, robot.initial), fraction=_share(len(absent)))


@check(points=1, covers="no-others", needs=("starts",), after=("names",))
@hint("Every declared name has work to do: what is not in the table is not declared.")
@hint("allow_undeclared_parameters lets every misspelling in: leave it out.")
def test_no_others(robot: Robot, draw: random.Random) -> None:
    """It declares nothing else, and refuses a name that was not declared."""
    found = robot.parameters.names()
    expect(bool(found & set(WANTED)), "It declares none of the parameters of the table.")
    others = sorted(found - set(WANTED))
    expect(not others, f"It also declares {parameters.shortened(', '.join(others))}.")
    name = draw.choice(("safty_distance", "max_linear_velocty", "control_freqency"))
    expect(not robot.parameters.change({name: 1.0}).accepted, f"It took 1.0 for {name}, a name that nobody declared.")


def _share(wrong: int) -> float:
    """Return the fraction of the points for all but so many of the six."""
    return round(0.8 * max(0.0, 1 - wrong / len(WANTED)), 2)


def _is_description(text: str, unit: str) -> bool:
    """Say whether a description has words, and among them the unit as one writes or speaks it."""
    words = {word.strip(".,;:()[]") for word in text.lower().replace("/", " ").replace("%", " percent ").split()}
    if unit == "m" and words & SPELT["s"]:
        return False  # that is a speed
    if unit == "Hz" and words & SPANS and "/" not in text and not words & PER:
        return False  # that is a time
    return bool(words) and all(words & SPELT[part] for part in unit.split("/") if part)


def _type_text(found: ParameterDescriptor | None) -> str:
    return "not declared" if found is None else parameters.TYPES.get(found.type, "an array")


def _range_fault(wanted: Wanted, found: ParameterDescriptor | None) -> str:
    if found is None:
        return "it is not declared"
    ranges = [*found.floating_point_range, *found.integer_range]
    if not ranges:
        return "no range"
    low, high = float(ranges[0].from_value), float(ranges[0].to_value)
    if abs(low - float(wanted.low or 0)) > 1e-9 or abs(high - float(wanted.high or 0)) > 1e-9:
        return f"its range is {low:g} to {high:g} instead of {wanted.low:g} to {wanted.high:g}"
    finest = 1 if isinstance(wanted.default, int) else 0
    return f"its range has steps of {ranges[0].step:g}" if ranges[0].step > finest else ""


def _outside(wanted: Wanted, draw: random.Random) -> tuple[parameters.Value, parameters.Value]:
    assert wanted.low is not None, "only what has limits is asked"
    assert wanted.high is not None, "only what has limits is asked"
    if isinstance(wanted.default, int):
        return int(wanted.low) - draw.randrange(1, 9), int(wanted.high) + draw.randrange(1, 9)
    return wanted.low - draw.uniform(0.05, 2.0), wanted.high + draw.uniform(0.05, 2.0)
