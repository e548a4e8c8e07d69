"""The runs of the student's tests, made together when the first check asks."""

from __future__ import annotations

import pytest

from autograder.checks.ch06_testing.support.contract import GUARD, LAUNCH, LEAST, LIMITS, PACKAGE, SCRIPTS
from autograder.harness import Workspace
from autograder.probes.test_reports import Report, Source, TestRun
from autograder.probes.test_runs import run, take
from autograder.probes.versions import Version

# Two mutants that anybody would think of. The hidden ones are less obvious.
LETS_ALL_PASS = {"speed_guard/limits.py": "def safe_speed(wanted, *distances, **more_distances):\n    return wanted\n"}
WITHOUT_CONFIGURATION = {
    "launch/guard.launch.py": """from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([Node(package='speed_guard', executable='speed_guard', name='speed_guard')])
"""
}
MUTANTS = {LIMITS: LETS_ALL_PASS, GUARD: LETS_ALL_PASS, LAUNCH: WITHOUT_CONFIGURATION}
RIGHT, MUTANT = "right", "mutant"


@pytest.fixture(scope="session")
def source(workspace: Workspace) -> Source:
    """The student's package."""
    return take(workspace, PACKAGE)


@pytest.fixture(scope="session")
def reports(workspace: Workspace, source: Source) -> dict[tuple[str, str], Report]:
    """What the tests of each file say of the package as it is, and of a mutant."""
    files = {name: data.decode(errors="replace") for name, data in source.files.items() if not name.startswith("test/")}
    version = Version(files, SCRIPTS)
    wanted: dict[tuple[str, str], TestRun] = {}
    for name in LEAST:
        if name in source.tests:
            wanted[name, RIGHT] = TestRun((name,), version)
            mutant = Version({**version.files, **MUTANTS[name]}, SCRIPTS)
            wanted[name, MUTANT] = TestRun((name,), mutant, first_failure=True)
    return dict(zip(wanted, run(workspace, source, list(wanted.values())), strict=True))
