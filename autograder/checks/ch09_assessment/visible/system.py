"""Question 3 at once: the messages, the build, and each node on a few temperatures."""

from __future__ import annotations

from collections.abc import Mapping

from autograder.checks import check, expect, hint
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
from autograder.checks.ch09_assessment.support.robot import Start, expect_executables, require_built
from autograder.diagnosis import Diagnosis
from autograder.harness import Workspace
from autograder.probes.installed import look


@check(points=1, holds=("temperature", "decision"), group="packages", doc=contract.INTERFACES_DOC)
@hint("Two files in msg/, a field a line: type, space, name.", "builtin_interfaces/Time stamp stands first.")
def test_definitions(workspace: Workspace) -> None:
    """Question 3: both messages have the fields of the contract."""
    expect_definitions(workspace)


@check(points=1, holds="packages", group="packages", depends=("definitions",), doc=contract.PACKAGES_DOC)
@hint("rosidl_generate_interfaces names both .msg files, and builtin_interfaces behind DEPENDENCIES.")
@hint("console_scripts in setup.py: thermometer = motor_guard.thermometer:main, and so on.")
def test_builds(workspace: Workspace, builds: Mapping[str, Diagnosis]) -> None:
    """Question 3: colcon builds both packages, and installs three programs and the launch file."""
    require_built(builds, INTERFACES)
    require_built(builds, PACKAGE)
    found = look(workspace.install, PACKAGE)
    expect_executables(found.executables, found.misplaced, PROGRAMS)
    expect(f"launch/{contract.LAUNCH_FILE}" in found.shared, f"launch/{contract.LAUNCH_FILE} is not installed.")


@check(points=1, holds="formula", group="nodes", depends=("builds",), doc=contract.NODES_DOC)
@hint("super().__init__('thermometer'), a publisher and a timer.", "The first reading has the number 0.")
def test_measures(start: Start) -> None:
    """Question 3: thermometer publishes its readings."""
    with start(THERMOMETER) as harness:
        harness.expect_in_graph()
        harness.expect_readings(3)


@check(points=1, holds="smoother", group="nodes", depends=("builds",), doc=contract.NODES_DOC)
@hint("deque(maxlen=window) forgets the oldest reading by itself.", "One average for each reading.")
def test_smooths(start: Start) -> None:
    """Question 3: smoother publishes the average of the newest readings."""
    with start(SMOOTHER) as harness:
        harness.expect_in_graph()
        seen = [round(message.celsius, 1) for message in harness.send([40.0, 50.0, 60.0])]
    expect(seen == [40.0, 45.0, 50.0], f"40, 50, 60 °C became {seen}, and should become [40.0, 45.0, 50.0].")


@check(points=1, holds="hysteresis", group="nodes", depends=("builds",), doc=contract.NODES_DOC)
@hint("Remember the last decision in self.", "Between the two thresholds nothing changes.")
def test_decides(start: Start) -> None:
    """Question 3: guard switches the fan on when it is hot and off when it is cool."""
    with start(GUARD) as harness:
        harness.expect_in_graph()
        seen = [message.cooling for message in harness.send([45.0, 65.0, 55.0, 45.0])]
    expect(seen == [False, True, True, False], f"45, 65, 55, 45 °C: cooling was {seen}.")
