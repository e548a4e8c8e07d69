"""Step 5: the declaration of the parameters, the configuration file, and the effect of changes."""

from __future__ import annotations

import math
import random

from autograder.checking import SCAN_SECONDS, CheckFailed, Workspace, expect, group, hint
from autograder.checking.probes import parameters
from autograder.checks.ch02_nodes.support.scans import Part, scan
from autograder.checks.ch08_capstone.hidden.drawn_drives import (
    CLEAR,
    DEFAULTS,
    DRIVE,
    LEFT,
    STILL,
    Drive,
    Moment,
    View,
    expect_drive,
)
from autograder.checks.ch08_capstone.hidden.drawn_reports import ALL_TOPICS, Span, expect_reports
from autograder.checks.ch08_capstone.hidden.exact_limits import OPEN, newest_clearance
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import (
    CONFIG,
    CONTROLLER,
    MONITOR,
    PACKAGE,
    PARAMETERS,
    PROCESSOR,
    TOLERANCE,
)
from autograder.checks.ch08_capstone.support.expectations import expect_driving
from autograder.checks.ch08_capstone.support.system import SharedSystem, System

check = group("step_5", doc=contract.PARAMETERS_DOC)
# Ranges from which other values are drawn. A speed is a maximum, so only a lower one shows; the others show either way.
VALUES: dict[str, dict[str, tuple[tuple[float, float], ...]]] = {
    CONTROLLER: {
        "safety_distance": ((0.32, 0.45), (0.8, 2.0)),
        "forward_speed": ((0.05, 0.2),),
        "turn_speed": ((0.1, 0.6),),
        "data_timeout": ((0.2, 0.3), (0.8, 1.9)),
    },
    PROCESSOR: {"half_angle": ((0.15, 0.4), (0.62, 0.78))},
    MONITOR: {"silence_timeout": ((0.2, 0.4), (1.3, 1.4))},
}


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
def test_used(system: System, lone_monitor: SharedSystem, draw: random.Random) -> None:
    """A parameter that is changed while the system runs has an effect immediately."""
    monitor, errors = lone_monitor.get(MONITOR), list[str]()
    for node, values in VALUES.items():
        changed_system = monitor if node == MONITOR else system
        for name, ranges in values.items():
            value = round(draw.uniform(*draw.choice(ranges)), 2)
            errors += _effect_errors(changed_system, node, name, value)
    errors += _errors_after_change_in_turn(system)
    if errors:
        total = sum(map(len, VALUES.values())) + 1
        raise CheckFailed(" ".join(errors[:2]), fraction=round(1.0 - len(errors) / total, 2))


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


def _effect_errors(system: System, node: str, name: str, value: float) -> list[str]:
    """Change a parameter, test the effect, and restore the parameter; describe the error, if there is one."""
    with system.changed_parameter(node, name, value) as reply:
        if not reply.accepted:
            return [f"{node} refuses {name} = {value:g}: {reply.reason}"]
        try:
            _expect_effect(system, name, value)
        except CheckFailed as error:
            return [f"With {name} = {value:g}: {error.message}"]
    return []


def _expect_effect(system: System, name: str, value: float) -> None:
    if name == "half_angle":
        inside, outside = math.degrees(value) - 3.0, math.degrees(value) + 2.0
        for bearing, expected in ((inside, 1.0), (-inside - 1.0, 1.0), (outside, 3.0), (-outside - 1.0, 3.0)):
            front = newest_clearance(system, scan(Part(bearing, bearing + 1.0, 1.0))).front
            sentence = f"something 1.00 m away at {bearing:.0f}° to {bearing + 1.0:.0f}° made front {front:.2f} m."
            expect(abs(front - expected) <= TOLERANCE, sentence)
    elif name == "silence_timeout":
        # Reports are 0.5 s apart: in three silences, they come at different times after the last messages.
        expect_reports(system, (Span(frozenset(), 13), Span(ALL_TOPICS, 4)) * 3, silence_timeout=value)
    else:
        limit = value if name == "safety_distance" else 0.6
        drives: dict[str, Drive] = {"data_timeout": (Moment(CLEAR), Moment(None, round(value / SCAN_SECONDS) + 3))}
        around = Moment(View(limit + 0.05, 2.0, 1.0)), Moment(View(limit - 0.05, 2.0, 1.0))
        kinds = (DRIVE, STILL) if name in drives else (DRIVE, LEFT)
        expect_drive(system, drives.get(name, around), *kinds, parameters={**DEFAULTS, name: value})


def _errors_after_change_in_turn(system: System) -> list[str]:
    """Describe the error if a turn does not end after safety_distance was set to a value that should end it."""
    obstacle = Part(-40.0, 40.0, 0.5)
    system.publish_scans(OPEN)
    system.publish_scans(scan(obstacle, fill=3.0))
    with system.changed_parameter(CONTROLLER, "safety_distance", 0.3):
        commands = system.publish_scans(scan(obstacle, fill=3.0)).commands
    try:
        expect_driving(commands, "With safety_distance set to 0.3 in a turn, 0.5 m before something", 0.3)
    except CheckFailed as error:
        return [error.message]
    return []
