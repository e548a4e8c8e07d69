"""Step 5: parameters that are declared with their limits, kept in a file, and used."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from autograder.checking import CheckFailed, ReceivedMessage, Workspace, expect, group, hint
from autograder.checking.probes import parameters
from autograder.checks.ch02_nodes.support.scans import Part, scan
from autograder.checks.ch08_capstone.hidden.exact_limits import OPEN, newest_clearance
from autograder.checks.ch08_capstone.hidden.health import repeat_until_after_report
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
from autograder.checks.ch08_capstone.support.system import System, expect_driving, expect_turning

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
    for node, wanted in PARAMETERS.items():
        asked = system.parameters_of(node)
        missing = parameters.missing_sentence(wanted, asked.names())
        expect(not missing, f"{node}: {missing}")
        wrong = parameters.differences(asked.values(*wanted), {name: bounds.default for name, bounds in wanted.items()})
        expect(not wrong, f"{node}: {'; '.join(wrong)}.", fraction=0.5)


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
    for node, wanted in PARAMETERS.items():
        asked = system.parameters_of(node)
        for name, descriptor in asked.descriptors(*wanted).items():
            bounds = wanted[name]
            ranges = [(each.from_value, each.to_value) for each in descriptor.floating_point_range]
            shown = f"{ranges[0][0]:g} to {ranges[0][1]:g}" if ranges else "no range"
            expect(
                ranges == [(bounds.lowest, bounds.highest)],
                f"{node}: {name} has {shown}, the contract asks {bounds.lowest:g} to {bounds.highest:g}.",
            )
            expect(bool(descriptor.description), f"{node}: {name} has no description.", fraction=0.5)
            refused = not asked.change({name: bounds.highest * 2}).accepted
            expect(refused, f"{node}: {name} can be set to {bounds.highest * 2:g}.")


@check(points=3, covers="declares", needs=("build",), after=("declared", "drives", "turns", "sectors", "dead_sensor"))
@hint("A value that is read once in __init__ never changes: self.get_parameter(name).value where it is needed.")
@hint("Every parameter of the table is used: a number in the code that stands for one makes it a decoration.")
def test_used(system: System) -> None:
    """A parameter that is changed while the system runs has an effect immediately."""
    wrong = [said for said in (_effect(system, *case) for case in _CASES) if said]
    wrong += _errors_after_change_in_turn(system)
    if wrong:
        raise CheckFailed(" ".join(wrong[:2]), fraction=round(1.0 - len(wrong) / (len(_CASES) + 1), 2))


@check(points=2, covers="config", needs=("build",), after=("shares",))
@hint("By node, then ros__parameters, then name and value, each level indented by two blanks.")
@hint("A name that no node declares is ignored without a word: compare letter by letter.")
def test_config(workspace: Workspace) -> None:
    """The configuration file holds every parameter with its default, by node."""
    file = parameters.read_file(workspace.install / PACKAGE / "share" / PACKAGE / CONFIG)
    for node, wanted in PARAMETERS.items():
        values = parameters.for_node(file, node)
        expect(bool(values), f"{CONFIG} says nothing for {node}; it has: {', '.join(file)}.")
        wrong = parameters.differences(values, {name: bounds.default for name, bounds in wanted.items()})
        expect(not wrong, f"{CONFIG}, {node}: {'; '.join(wrong)}.", fraction=0.5)
        extra = sorted(set(values) - {name for bounds in PARAMETERS.values() for name in bounds})
        expect(not extra, f"{CONFIG}, {node}: {', '.join(extra)} is not declared by any node.", fraction=0.5)


def _safety_distance(system: System) -> None:
    expect_turning(_settled(system, Part(-10.0, 10.0, 1.2)), "with something 1.2 m ahead", "left", 0.8)


def _forward_speed(system: System) -> None:
    expect_driving(_settled(system), "with nothing around", 0.12)


def _turn_speed(system: System) -> None:
    expect_turning(_settled(system, Part(-10.0, 10.0, 0.4)), "with something 0.4 m ahead", "left", 0.25)


def _data_timeout(system: System) -> None:
    _settled(system)
    began = system.seconds
    system.wait(1.2)
    expect_driving(system.messages(began + 0.7).commands, "with data 1.2 s old at most", 0.3)


def _half_angle(system: System) -> None:
    system.see(OPEN)
    front = newest_clearance(system, scan(Part(22.0, 26.0, 1.0))).front
    expect(front > 2.0, "something at 24° was still ahead.")


def _silence_timeout(system: System) -> None:
    system.see(OPEN, 1.0)
    repeat_until_after_report(system, lambda: system.show(OPEN))
    began = system.seconds
    system.wait(0.9)
    said = system.messages(began + 0.4).reports
    expect(bool(said) and said[-1].message.level == FAILED, "0.9 s after the last scan, health was not FAILED.")


_CASES: tuple[tuple[str, str, float, Callable[[System], None]], ...] = (
    (CONTROLLER, "safety_distance", 1.5, _safety_distance),
    (CONTROLLER, "forward_speed", 0.12, _forward_speed),
    (CONTROLLER, "turn_speed", 0.25, _turn_speed),
    (CONTROLLER, "data_timeout", 2.0, _data_timeout),
    (PROCESSOR, "half_angle", 0.35, _half_angle),
    (MONITOR, "silence_timeout", 0.3, _silence_timeout),
)


def _effect(system: System, node: str, name: str, value: float, look: Callable[[System], None]) -> str:
    """Change a parameter, look at what comes of it, and change it back; say what was wrong."""
    try:
        with system.changed(node, name, value) as reply:
            if not reply.accepted:
                return f"{node} refuses {name} = {value:g}: {reply.reason}"
            look(system)
    except CheckFailed as failed:
        return f"With {name} = {value:g}: {failed.message}"
    finally:
        system.see(OPEN)
    return ""


def _errors_after_change_in_turn(system: System) -> list[str]:
    """Say how the robot goes on turning after safety_distance was set so low that the turn has to end, if so."""
    ahead = Part(-40.0, 40.0, 0.5)
    _settled(system, ahead)
    with system.changed(CONTROLLER, "safety_distance", 0.3):
        commands = system.see(scan(ahead, fill=3.0)).commands
    try:
        expect_driving(commands, "With safety_distance set to 0.3 in a turn, 0.5 m before something", 0.3)
    except CheckFailed as failed:
        return [failed.message]
    return []


def _settled(system: System, *parts: Part) -> Sequence[ReceivedMessage]:
    """Show an open space, then these things in it; return the commands that followed."""
    system.see(OPEN)
    return system.see(scan(*parts, fill=3.0)).commands
