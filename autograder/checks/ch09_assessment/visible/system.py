"""Question 3: the messages, the build, each node with a few temperatures, and the launch."""

from __future__ import annotations

import math
from collections.abc import Mapping

from autograder.checking import Diagnosis, LaunchHarness, Workspace, check, expect, hint
from autograder.checking.probes import imports, installed, launch_probe, manifest
from autograder.checks.ch09_assessment.support import contract
from autograder.checks.ch09_assessment.support.contract import (
    GUARD,
    INTERFACES,
    PACKAGE,
    PROGRAMS,
    SMOOTHER,
    THERMOMETER,
)
from autograder.checks.ch09_assessment.support.definitions import expect_definitions
from autograder.checks.ch09_assessment.support.robot import Start, expect_executables, require_built, source_of


@check(points=1, covers=("temperature", "decision"), group="packages", doc=contract.INTERFACES_DOC)
@hint("Two files in msg/, one field per line: type, space, name.", "builtin_interfaces/Time stamp is the first field.")
def test_definitions(workspace: Workspace) -> None:
    """Question 3: both messages have the fields of the contract."""
    expect_definitions(workspace)


@check(points=1, covers="packages", group="packages", after=("definitions",), doc=contract.PACKAGES_DOC)
@hint("rosidl_generate_interfaces names both .msg files, and builtin_interfaces after DEPENDENCIES.")
@hint("console_scripts in setup.py: thermometer = motor_guard.thermometer:main, and so on.")
def test_builds(workspace: Workspace, builds: Mapping[str, Diagnosis]) -> None:
    """Question 3: colcon builds both packages, installs three programs and the launch file; imports are declared."""
    require_built(builds, INTERFACES)
    require_built(builds, PACKAGE)
    installation = installed.inspect_package(workspace.install, PACKAGE)
    expect_executables(installation.executables, installation.misplaced, PROGRAMS)
    expect(f"launch/{contract.LAUNCH_FILE}" in installation.shared, f"launch/{contract.LAUNCH_FILE} is not installed.")
    source = source_of(workspace, PACKAGE)
    missing = imports.missing(source, manifest.read(source))["exec"]
    expect(not missing, f"{imports.describe(missing)}: package.xml does not declare it.")


@check(points=1, covers="formula", group="nodes", after=("builds",), doc=contract.NODES_DOC)
@hint("super().__init__('thermometer'), a publisher and a timer.", "The first reading has the number 0.")
def test_measures(start: Start) -> None:
    """Question 3: thermometer publishes its readings, also with another period, mean and swing."""
    with start(THERMOMETER) as harness:
        harness.expect_in_graph()
        harness.expect_readings(3)
    with start(THERMOMETER, period=0.25, mean=10.0, swing=2.0) as harness:
        harness.expect_readings(6, 0.25, 10.0, 2.0)


@check(points=1, covers=("smoother", "window"), group="nodes", after=("builds",), doc=contract.NODES_DOC)
@hint("deque(maxlen=window) forgets the oldest reading by itself.", "One average for each reading that is finite.")
def test_smooths(start: Start) -> None:
    """Question 3: smoother publishes the mean of the finite readings in its window, with the newest stamp."""
    with start(SMOOTHER) as harness:
        harness.expect_in_graph()
        averages = harness.send([40.0, 50.0, math.nan, 60.0])
    actual = [round(message.celsius, 1) for message in averages]
    expect(actual == [40.0, 45.0, 50.0], f"40, 50, nan, 60 °C became {actual} instead of [40.0, 45.0, 50.0].")
    stamps = [message.stamp.sec for message in averages]
    expect(stamps == [1, 2, 4], f"The stamps were {stamps} s instead of [1, 2, 4] s, those of the newest readings.")
    with start(SMOOTHER, window=2) as harness:
        actual = [round(message.celsius, 1) for message in harness.send([40.0, 50.0, 70.0])]
    expect(
        actual == [40.0, 45.0, 60.0],
        f"With window 2, 40, 50, 70 °C became {actual} instead of [40.0, 45.0, 60.0].",
    )


@check(points=1, covers=("hysteresis", "unknown"), group="nodes", after=("builds",), doc=contract.NODES_DOC)
@hint(
    "Remember the last decision in self.",
    "Between the two thresholds nothing changes.",
    "nan is an unknown temperature: the fan runs.",
)
def test_decides(start: Start) -> None:
    """Question 3: guard decides at hot, cool and unknown temperatures, and passes stamp and temperature on."""
    with start(GUARD) as harness:
        harness.expect_in_graph()
        decisions = harness.send([45.0, 65.0, 55.0, 45.0, math.nan])
    actual = [message.cooling for message in decisions]
    expected = [False, True, True, False, True]
    expect(actual == expected, f"At 45, 65, 55, 45, nan °C, cooling was {actual} instead of {expected}.")
    inputs = [(message.stamp.sec, round(message.celsius, 1)) for message in decisions[:3]]
    expect(inputs == [(1, 45.0), (2, 65.0), (3, 55.0)], f"Stamps and temperatures of the decisions were {inputs}.")


@check(
    points=1,
    covers=("launch", "hot-argument", "ctrl-c"),
    group="launch",
    after=("builds", "measures", "smooths", "decides"),
    doc=contract.LAUNCH_DOC,
)
@hint("Node(package='motor_guard', executable='guard', name='guard', parameters=[{'hot': hot}]), and two more.")
@hint("ParameterValue(LaunchConfiguration('hot'), value_type=float)")
def test_launches(workspace: Workspace) -> None:
    """Question 3: launched with hot:=71, the three nodes run under their names, and guard's hot is 71.0."""
    with LaunchHarness(workspace, PACKAGE, contract.LAUNCH_FILE, {"hot": "71"}) as harness:
        launch_probe.expect_nodes(harness, [f"/{name}" for name in PROGRAMS])
        launch_probe.expect_parameters(harness, f"/{GUARD}", {"hot": 71.0})
        launch_probe.expect_clean_stop(harness)
