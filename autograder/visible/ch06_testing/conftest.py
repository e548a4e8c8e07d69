"""The runs of the student's tests, made together when the first check asks."""

from __future__ import annotations

import pytest

from autograder.lab import Workspace
from autograder.probes.testing import Order, Report, run, source_of
from autograder.probes.versions import Version, read
from autograder.visible.ch06_testing.contract import GUARD, LAUNCH, LEAST, LIMITS, PACKAGE, SCRIPTS

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
def reports(workspace: Workspace) -> dict[tuple[str, str], Report]:
    """What the tests of each file say of the package as it is, and of a mutant."""
    source = source_of(workspace, PACKAGE)
    version = read(source, SCRIPTS)
    orders: dict[tuple[str, str], Order] = {}
    for name in LEAST:
        if (source / "test" / name).is_file():
            orders[name, RIGHT] = Order((name,), version)
            mutant = Version({**version.files, **MUTANTS[name]}, SCRIPTS)
            orders[name, MUTANT] = Order((name,), mutant, first_failure=True)
    return dict(zip(orders, run(workspace, PACKAGE, list(orders.values())), strict=True))
