"""Question 3: one command starts the three nodes, and Ctrl-C ends them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from random import Random

import pytest

from autograder.checking import CheckFailed, Diagnosis, LaunchHarness, Workspace, expect, group, hint
from autograder.checking.probes import installed, launch_probe, parameters
from autograder.checks.ch09_assessment.support import contract
from autograder.checks.ch09_assessment.support.contract import (
    COOL,
    GUARD,
    LAUNCH_FILE,
    MEAN,
    PACKAGE,
    PERIOD,
    PROGRAMS,
    SMOOTHER,
    SWING,
    THERMOMETER,
    WINDOW,
)
from autograder.checks.ch09_assessment.support.robot import Start, Types, require_built

check = group("launch", doc=contract.LAUNCH_DOC)
NODES = tuple(f"/{name}" for name in PROGRAMS)
DEFAULTS: dict[str, dict[str, parameters.Value]] = {  # the defaults of parameters that no argument sets
    THERMOMETER: {"period": PERIOD, "mean": MEAN, "swing": SWING},
    SMOOTHER: {"window": WINDOW},
    GUARD: {"cool": COOL},
}
FIRST_SECONDS = 20.0  # s of real time to wait for the first decision, which takes one period


def draw_hot(seed: int) -> int:
    """Draw the argument hot, a whole number of degrees Celsius."""
    return Random(f"{seed}:hot").randint(52, 58)


@dataclass(frozen=True)
class SharedLaunches:
    """The launches that all checks share.

    Attributes:
        harness: the launch that the checks test.
        with_integer: the launch with a whole number for hot; the same one unless the guard did not run in it.
    """

    harness: LaunchHarness
    with_integer: LaunchHarness


@pytest.fixture(scope="module")
def launched(workspace: Workspace, builds: Mapping[str, Diagnosis], types: Types, hot: int) -> Iterator[SharedLaunches]:
    """One launch for all checks of this module, and a second one if the guard refuses a whole number."""
    require_built(builds, PACKAGE)
    shared = installed.inspect_package(workspace.install, PACKAGE).shared
    expect(f"launch/{LAUNCH_FILE}" in shared, f"launch/{LAUNCH_FILE} is not installed: look at data_files in setup.py.")
    subscribes = {"/decision": types.decision}
    with LaunchHarness(workspace, PACKAGE, LAUNCH_FILE, {"hot": str(hot)}, subscribes=subscribes) as with_integer:
        # A guard that refuses the number is in the graph for a moment, but never answers.
        is_there = f"/{GUARD}" in launch_probe.settle(with_integer, NODES)
        if is_there and with_integer.parameters(f"/{GUARD}", ["hot"]) is not None:
            yield SharedLaunches(with_integer, with_integer)
            return
    with LaunchHarness(workspace, PACKAGE, LAUNCH_FILE, {"hot": f"{hot}.0"}, subscribes=subscribes) as harness:
        yield SharedLaunches(harness, with_integer)


@pytest.fixture(scope="module")
def hot(seed: int) -> int:
    """The argument hot of the launch, a whole number of degrees Celsius."""
    return draw_hot(seed)


@check(
    points=3,
    covers=("launch", "set-up", "thermometer-topics", "smoother-topics", "guard-topics"),
    after=("installs",),
)
@hint("Node(package='motor_guard', executable='guard', name='guard', output='screen'), and two more.")
@hint("ros2 topic echo /decision shows whether the three nodes exchange messages.")
def test_launches(launched: SharedLaunches) -> None:
    """The installed launch file starts the three nodes under their names, and they publish decisions."""
    harness = launched.harness
    launch_probe.expect_nodes(harness, NODES)
    has_decision = harness.wait_for(lambda: bool(harness.messages("/decision")), FIRST_SECONDS)
    expect(has_decision, f"All three nodes run, but published no decision in {FIRST_SECONDS:.0f} s.", fraction=0.5)


@check(points=2, covers=("hot-argument", "hot-cool"), after=("launches",))
@hint("DeclareLaunchArgument('hot', default_value='60.0')")
@hint("ParameterValue(LaunchConfiguration('hot'), value_type=float): without it, 55 becomes an integer.")
def test_argument(workspace: Workspace, launched: SharedLaunches, start: Start, hot: int, draw: Random) -> None:
    """The launch argument hot, by default 60.0, sets the guard's parameter hot, always as a float."""
    harness = launched.harness
    launch_probe.expect_parameters(harness, f"/{GUARD}", {"hot": float(hot)})
    reason = launch_probe.failure(launched.with_integer.output)
    expect(harness is launched.with_integer, f"Launched with hot:={hot}, guard does not run. {reason}", fraction=0.5)
    arguments = launch_probe.declared_arguments(workspace, PACKAGE, LAUNCH_FILE)
    launch_probe.expect_argument(arguments, "hot", "60.0", described=False)
    for name, values in DEFAULTS.items():
        launched_values = harness.parameters(f"/{name}", list(values)) or {}
        if parameters.differences(launched_values, values):  # other checks test the node's own defaults
            with start(name) as lone_harness:
                own_values = parameters.NodeParameters(lone_harness, f"/{name}").values(*values)
            differences = parameters.differences(launched_values, own_values)
            message = f"Launched with only hot:={hot}, {name} differs from {name} alone: {'; '.join(differences)}."
            expect(not differences, message, fraction=0.75)
    fraction = hot + draw.randrange(100_001, 1_000_000, 2) / 1e6  # six decimal places, none of which may be lost
    with LaunchHarness(workspace, PACKAGE, LAUNCH_FILE, {"hot": str(fraction)}) as precise_launch:
        launch_probe.settle(precise_launch, NODES)
        try:
            launch_probe.expect_parameters(precise_launch, f"/{GUARD}", {"hot": fraction})
        except CheckFailed as error:
            raise CheckFailed(f"Launched with hot:={fraction}: {error.message}", fraction=0.5) from error


@check(points=1, covers="ctrl-c", after=("launches",))
@hint("Each main() catches KeyboardInterrupt and ExternalShutdownException: running.py does this.")
@hint("A node in an endless loop has to be killed: check the loops that you wrote.")
def test_stops(launched: SharedLaunches) -> None:
    """Ctrl-C ends the launch and all of its nodes, cleanly."""
    expect(bool(launched.harness.nodes()), "No node is running, so Ctrl-C has nothing to end.")
    launch_probe.expect_clean_stop(launched.harness)
