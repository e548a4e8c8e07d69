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
# Ranges from which other values are drawn. A speed is a maximum, so only a lower speed has a visible effect.
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
        missing_sentence = parameters.missing_sentence(bounds_by_name, node_parameters.names())
        expect(not missing_sentence, f"{node}: {missing_sentence}")
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
    """Each parameter has a description and the range of the contract, and a value outside its range is refused."""
    for node, bounds_by_name in PARAMETERS.items():
        node_parameters = system.parameters_of(node)
        for name, descriptor in node_parameters.descriptors(*bounds_by_name).items():
            bounds = bounds_by_name[name]
            ranges = [(limits.from_value, limits.to_value) for limits in descriptor.floating_point_range]
            actual = f"the range {ranges[0][0]:g} to {ranges[0][1]:g}" if ranges else "no range"
            expect(
                ranges == [(bounds.lowest, bounds.highest)],
                f"{node}: {name} has {actual}, instead of the range {bounds.lowest:g} to {bounds.highest:g}.",
            )
            expect(bool(descriptor.description), f"{node}: {name} has no description.", fraction=0.5)
            is_refused = not node_parameters.change({name: bounds.highest * 2}).accepted
            expect(is_refused, f"{node}: {name} can be set to {bounds.highest * 2:g}, which is outside its range.")


@check(points=3, covers="declares", needs=("build",), after=("declared", "drives", "turns", "sectors", "dead_sensor"))
@hint("A value that is read only in __init__ never changes: call self.get_parameter(name).value where you need it.")
@hint("Use every parameter of the table. Do not write its value as a number in the code.")
def test_used(system: System, lone_monitor: SharedSystem, draw: random.Random) -> None:
    """A change to a parameter takes effect immediately, while the system runs."""
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
@hint("Write a node's name, then ros__parameters, then names and values. Indent each level by two spaces.")
@hint("A name that no node declares is ignored without a warning: compare letter by letter.")
def test_config(workspace: Workspace) -> None:
    """The configuration file holds every parameter with its default, grouped by node."""
    config = parameters.read_file(workspace.install / PACKAGE / "share" / PACKAGE / CONFIG)
    for node, bounds_by_name in PARAMETERS.items():
        values = parameters.for_node(config, node)
        expect(bool(values), f"{CONFIG} has no parameters for {node}. Its nodes: {', '.join(config)}.")
        differences = parameters.differences(values, {name: bounds.default for name, bounds in bounds_by_name.items()})
        expect(not differences, f"{CONFIG}, {node}: {'; '.join(differences)}.", fraction=0.5)
        extra_names = sorted(set(values) - {name for bounds in PARAMETERS.values() for name in bounds})
        expect(not extra_names, f"{CONFIG}, {node}: no node declares {', '.join(extra_names)}.", fraction=0.5)


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
        inner, outer = math.degrees(value) - 3.0, math.degrees(value) + 2.0  # bearings around the edge of the sector
        for bearing, expected in ((inner, 1.0), (-inner - 1.0, 1.0), (outer, 3.0), (-outer - 1.0, 3.0)):
            front = newest_clearance(system, scan(Part(bearing, bearing + 1.0, 1.0))).front
            situation = f"with something 1.00 m away at {bearing:.0f}° to {bearing + 1.0:.0f}°"
            sentence = f"{situation}, front was {front:.2f} m instead of {expected:.2f} m."
            expect(abs(front - expected) <= TOLERANCE, sentence)
    elif name == "silence_timeout":
        # Reports are 0.5 s apart. In three silences, they are published at different times after the last messages.
        expect_reports(system, (Span(frozenset(), 13), Span(ALL_TOPICS, 4)) * 3, silence_timeout=value)
    else:
        limit = value if name == "safety_distance" else 0.6
        drive_by_parameter: dict[str, Drive] = {
            "data_timeout": (Moment(CLEAR), Moment(None, round(value / SCAN_SECONDS) + 3))
        }
        drive_around_limit = Moment(View(limit + 0.05, 2.0, 1.0)), Moment(View(limit - 0.05, 2.0, 1.0))
        kinds = (DRIVE, STILL) if name in drive_by_parameter else (DRIVE, LEFT)
        expect_drive(
            system, drive_by_parameter.get(name, drive_around_limit), *kinds, parameters={**DEFAULTS, name: value}
        )


def _errors_after_change_in_turn(system: System) -> list[str]:
    """Describe the error if a turn does not end after safety_distance was set to a value that should end it."""
    obstacle = Part(-40.0, 40.0, 0.5)
    system.publish_scans(OPEN)
    system.publish_scans(scan(obstacle, fill=3.0))
    with system.changed_parameter(CONTROLLER, "safety_distance", 0.3):
        commands = system.publish_scans(scan(obstacle, fill=3.0)).commands
    try:
        expect_driving(commands, "After safety_distance was set to 0.3 m in a turn, with something 0.5 m ahead", 0.3)
    except CheckFailed as error:
        return [error.message]
    return []
