"""Steps 2 and 5 at once: the three nodes on a few scans, and their parameters."""

from __future__ import annotations

import math

from autograder.checks import check, expect, hint
from autograder.checks.ch02_nodes.support.scans import Part, scan
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import (
    DEGRADED,
    FAILED,
    LEVELS,
    OK,
    PARAMETERS,
    PROGRAMS,
    TOLERANCE,
    name_of,
)
from autograder.checks.ch08_capstone.support.system import System, expect_driving, expect_still, expect_turning
from autograder.probes.parameters import differences, missing_sentence

OPEN = scan(fill=3.0)


@check(
    points=1,
    holds=("processor-name", "controller-name", "monitor-name"),
    group="step_2",
    depends=("package", "definitions", "interfaces_build"),
    doc=contract.NODES_DOC,
)
@hint("The sentence above names the error, the lines below it say where.")
def test_starts(system: System) -> None:
    """Step 2: the three nodes start under their names."""
    nodes = system.harness.nodes()
    absent = [name_of(program) for program in PROGRAMS if name_of(program) not in nodes]
    expect(not absent, f"No node is called {' or '.join(absent)}; there is: {', '.join(nodes) or 'none'}.")


@check(points=1, holds=("processor", "sector"), group="step_2", depends=("starts",), doc=contract.SCAN_DOC)
@hint("scan comes best-effort: qos_profile_sensor_data.")
@hint("A beam's bearing is angle_min + i * angle_increment, wrapped to (-pi, pi]; left is positive.")
def test_sees(system: System) -> None:
    """Step 2: sensor_processor says how near things are ahead, on the left and on the right, and when it is blind."""
    shown = scan(Part(-5.0, 5.0, 1.0), Part(80.0, 90.0, 1.5), Part(-90.0, -80.0, 2.0), fill=3.0)
    found = system.see(shown).clearances
    expect(bool(found), "No clearance came while scans did.")
    newest = found[-1].message
    given = (newest.front, newest.left, newest.right)
    near = all(abs(one - other) <= TOLERANCE for one, other in zip(given, (1.0, 1.5, 2.0), strict=True))
    shown_as = ", ".join(f"{distance:.2f}" for distance in given)
    expect(
        near and newest.valid, f"front, left, right were {shown_as}, valid {newest.valid}: 1.0, 1.5, 2.0, True it is."
    )
    blind = system.see(scan(Part(-35.0, 35.0, math.nan))).clearances
    expect(bool(blind) and not blind[-1].message.valid, "With nan from every beam ahead, the clearance was valid.")


@check(points=1, holds=("drive", "turn", "untrusted"), group="step_2", depends=("sees",), doc=contract.NODES_DOC)
@hint("No clearance, one that is not valid, one whose stamp is old: publish Twist() as it is.")
@hint("Way clear: linear.x = forward_speed. Something ahead: angular.z towards the side with more room.")
def test_moves(system: System) -> None:
    """Step 2: navigation_controller drives, turns away, and stands still when it sees nothing."""
    expect_still(system.first.commands, "Before the first scan")
    expect_driving(system.see(OPEN).commands, "With 3 m of free space all around", 0.3)
    wall = scan(Part(-10.0, 10.0, 0.4), Part(70.0, 110.0, 1.0), fill=3.0)
    expect_turning(system.see(wall).commands, "With a wall 0.4 m ahead and less room on the left", "right", 0.8)
    system.see(OPEN)
    began = system.seconds
    system.wait(1.5)
    expect_still(system.messages(began + 1.0).commands, "A second after the last scan")


@check(points=1, holds="level", group="step_2", depends=("sees",), doc=contract.NODES_DOC)
@hint("FAILED if any topic is silent; else DEGRADED if the newest clearance is not valid; else OK.")
@hint("Remember when each topic was last heard; only a timer can hear the silence.")
def test_watches(system: System) -> None:
    """Step 2: status_monitor says OK, DEGRADED when the lidar is blocked, and FAILED within 2 s when it is dead."""
    for what, seen, wanted in (
        ("With scans", system.see(OPEN, 2.0), OK),
        ("With nan from every beam ahead", system.see(scan(Part(-35.0, 35.0, math.nan)), 2.0), DEGRADED),
        ("2 s after the last scan", system.wait(2.0), FAILED),
    ):
        expect(bool(seen.reports), f"{what}, no report came on health.")
        level = seen.reports[-1].message.level
        said = LEVELS[level] if level < len(LEVELS) else level
        expect(level == wanted, f"{what}, health was {said} instead of {LEVELS[wanted]}.")


@check(
    points=1,
    holds=("half_angle", "forward_speed", "turn_speed", "safety_distance", "data_timeout", "silence_timeout"),
    group="step_5",
    depends=("starts",),
    doc=contract.PARAMETERS_DOC,
)
@hint("declare(self, 'safety_distance', 0.6, 0.3, 2.0, '...') in __init__, and so on.")
def test_parameters(system: System) -> None:
    """Step 5: each node declares its parameters with their defaults and ranges."""
    for node, wanted in PARAMETERS.items():
        asked = system.parameters(node)
        missing = missing_sentence(wanted, asked.names())
        expect(not missing, f"{node}: {missing}")
        wrong = differences(asked.values(*wanted), {name: bounds.default for name, bounds in wanted.items()})
        expect(not wrong, f"{node}: {'; '.join(wrong)}.")
        for name, descriptor in asked.descriptors(*wanted).items():
            ranges = [(each.from_value, each.to_value) for each in descriptor.floating_point_range]
            bounds = wanted[name]
            expect(
                ranges == [(bounds.lowest, bounds.highest)], f"{node}: the range of {name} is not that of the table."
            )
