"""Step 5: the declaration of the parameters, the configuration file, and the effect of changes."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from autograder.checking import CheckFailed, ReceivedMessage, Workspace, expect, group, hint
from autograder.checking.probes import parameters
from autograder.checks.ch02_nodes.support.scans import Part, scan
from autograder.checks.ch08_capstone.hidden.exact_limits import OPEN, newest_clearance
from autograder.checks.ch08_capstone.hidden.reports import repeat_until_phase
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import (
    CONFIG,
    CONTROLLER,
    FAILED,
    MONITOR,
    PACKAGE,
    PARAMETERS,
    PROCESSOR,
)
from autograder.checks.ch08_capstone.support.expectations import expect_driving, expect_turning
from autograder.checks.ch08_capstone.support.system import System

check = group("step_5", doc=contract.PARAMETERS_DOC)


@check(
    points=2,
    covers=(
        "double",
        "declares",
        "half_angle",
        "forward_speed",
        "turn_speed",
        "safety_distance",
        "data_timeout",
        "silence_timeout",
    ),
    needs=("build",),
    after=("processor", "controller", "monitor"),
)
@hint("ros2 param list /navigation_controller shows what a node declares.")
@hint("declare(self, 'safety_distance', 0.6, 0.3, 2.0, '...'): name and default as in the table.")
def test_declared(system: System) -> None:
    """Each node declares its parameters, with the defaults of the contract."""
    for node, bounds_by_name in PARAMETERS.items():
        node_parameters = system.parameters_of(node)
        missing = parameters.missing_sentence(bounds_by_name, node_parameters.names())
        expect(not missing, f"{node}: {missing}")
        differences = parameters.differences(
            node_parameters.values(*bounds_by_name), {name: bounds.default for name, bounds in bounds_by_name.items()}
        )
        expect(not differences, f"{node}: {'; '.join(differences)}.", fraction=0.5)


@check(
    points=2,
    covers=(
        "declares",
        "half_angle",
        "forward_speed",
        "turn_speed",
        "safety_distance",
        "data_timeout",
        "silence_timeout",
    ),
    needs=("build",),
    after=("declared",),
)
@hint("ros2 param describe /navigation_controller safety_distance shows the range.")
@hint("floating_point_range=[FloatingPointRange(from_value=0.3, to_value=2.0)] in the ParameterDescriptor.")
def test_ranges(system: System) -> None:
    """Each parameter has a description and the range of the contract, and a value outside is refused."""
    for node, bounds_by_name in PARAMETERS.items():
        node_parameters = system.parameters_of(node)
        for name, descriptor in node_parameters.descriptors(*bounds_by_name).items():
            bounds = bounds_by_name[name]
            ranges = [(limits.from_value, limits.to_value) for limits in descriptor.floating_point_range]
            actual = f"{ranges[0][0]:g} to {ranges[0][1]:g}" if ranges else "no range"
            expect(
                ranges == [(bounds.lowest, bounds.highest)],
                f"{node}: {name} has {actual}, the contract asks {bounds.lowest:g} to {bounds.highest:g}.",
            )
            expect(bool(descriptor.description), f"{node}: {name} has no description.", fraction=0.5)
            is_refused = not node_parameters.change({name: bounds.highest * 2}).accepted
            expect(is_refused, f"{node}: {name} can be set to {bounds.highest * 2:g}.")


@check(points=3, covers="declares", needs=("build",), after=("declared", "drives", "turns", "sectors", "dead_sensor"))
@hint("A value that is read once in __init__ never changes: self.get_parameter(name).value where it is needed.")
@hint("Every parameter of the table is used: a number in the code that stands for one makes it a decoration.")
def test_used(system: System) -> None:
    """A parameter that is changed while the system runs has an effect immediately."""
    errors = [error for error in (_effect_error(system, *case) for case in _CASES) if error]
    errors += _errors_after_change_in_turn(system)
    if errors:
        raise CheckFailed(" ".join(errors[:2]), fraction=round(1.0 - len(errors) / (len(_CASES) + 1), 2))


@check(points=2, covers="config", needs=("build",), after=("shares",))
@hint("By node, then ros__parameters, then name and value, each level indented by two blanks.")
@hint("A name that no node declares is ignored without a word: compare letter by letter.")
def test_config(workspace: Workspace) -> None:
    """The configuration file holds every parameter with its default, by node."""
    config = parameters.read_file(workspace.install / PACKAGE / "share" / PACKAGE / CONFIG)
    for node, bounds_by_name in PARAMETERS.items():
        values = parameters.for_node(config, node)
        expect(bool(values), f"{CONFIG} says nothing for {node}; it has: {', '.join(config)}.")
        differences = parameters.differences(values, {name: bounds.default for name, bounds in bounds_by_name.items()})
        expect(not differences, f"{CONFIG}, {node}: {'; '.join(differences)}.", fraction=0.5)
        extra = sorted(set(values) - {name for bounds in PARAMETERS.values() for name in bounds})
        expect(not extra, f"{CONFIG}, {node}: {', '.join(extra)} is not declared by any node.", fraction=0.5)


def _expect_safety_distance(system: System) -> None:
    expect_turning(_commands_after(system, Part(-10.0, 10.0, 1.2)), "with something 1.2 m ahead", "left", 0.8)


def _expect_forward_speed(system: System) -> None:
    expect_driving(_commands_after(system), "with nothing around", 0.12)


def _expect_turn_speed(system: System) -> None:
    expect_turning(_commands_after(system, Part(-10.0, 10.0, 0.4)), "with something 0.4 m ahead", "left", 0.25)


def _expect_data_timeout(system: System) -> None:
    _commands_after(system)
    start = system.seconds
    system.wait(1.2)
    expect_driving(system.messages(start + 0.7).commands, "with data 1.2 s old at most", 0.3)


def _expect_half_angle(system: System) -> None:
    system.publish_scans(OPEN)
    front = newest_clearance(system, scan(Part(22.0, 26.0, 1.0))).front
    expect(front > 2.0, "something at 24° was still ahead.")


def _expect_silence_timeout(system: System) -> None:
    system.publish_scans(OPEN, 1.0)
    repeat_until_phase(system, lambda: system.publish_scan(OPEN))
    start = system.seconds
    system.wait(0.9)
    reports = system.messages(start + 0.4).reports
    expect(bool(reports) and reports[-1].message.level == FAILED, "0.9 s after the last scan, health was not FAILED.")


_CASES: tuple[tuple[str, str, float, Callable[[System], None]], ...] = (
    (CONTROLLER, "safety_distance", 1.5, _expect_safety_distance),
    (CONTROLLER, "forward_speed", 0.12, _expect_forward_speed),
    (CONTROLLER, "turn_speed", 0.25, _expect_turn_speed),
    (CONTROLLER, "data_timeout", 2.0, _expect_data_timeout),
    (PROCESSOR, "half_angle", 0.35, _expect_half_angle),
    (MONITOR, "silence_timeout", 0.3, _expect_silence_timeout),
)


def _effect_error(system: System, node: str, name: str, value: float, expect_effect: Callable[[System], None]) -> str:
    """Change a parameter, test the effect, and change it back; describe the error, if there is one."""
    try:
        with system.changed_parameter(node, name, value) as reply:
            if not reply.accepted:
                return f"{node} refuses {name} = {value:g}: {reply.reason}"
            expect_effect(system)
    except CheckFailed as error:
        return f"With {name} = {value:g}: {error.message}"
    finally:
        system.publish_scans(OPEN)
    return ""


def _errors_after_change_in_turn(system: System) -> list[str]:
    """Describe the error if a turn does not end after safety_distance was set to a value that ends it."""
    obstacle = Part(-40.0, 40.0, 0.5)
    _commands_after(system, obstacle)
    with system.changed_parameter(CONTROLLER, "safety_distance", 0.3):
        commands = system.publish_scans(scan(obstacle, fill=3.0)).commands
    try:
        expect_driving(commands, "With safety_distance set to 0.3 in a turn, 0.5 m before something", 0.3)
    except CheckFailed as error:
        return [error.message]
    return []


def _commands_after(system: System, *parts: Part) -> Sequence[ReceivedMessage]:
    """Publish an open space, then these things in it; return the commands that follow."""
    system.publish_scans(OPEN)
    return system.publish_scans(scan(*parts, fill=3.0)).commands
