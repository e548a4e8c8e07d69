"""Checks of the dancer, started as `ros2 run` starts it."""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass

import pytest
import yaml

from autograder.checking import SteppedHarness, Workspace, expect, group, hint, reading
from autograder.checking.probes import installed, student_yaml
from autograder.checks.ch01_package_structure.support import contract, robots

check = group("run")
HINTS = (
    "What does ros2 run square_dance dancer print in a new shell, after source install/setup.bash?",
    "An entry point has the form name = package.folder.module:function.",
)


@dataclass(frozen=True)
class RunningDancer:
    """A dancer in a harness, and the side length of its square in metres."""

    harness: SteppedHarness
    side: float


@pytest.fixture(scope="module")
def running_dancer(workspace: Workspace, seed: int) -> Iterator[RunningDancer]:
    """The dancer that the checks `starts` and `dances` share."""
    side = round(random.Random(f"{seed}:side").uniform(0.5, 1.5), 2)
    with robots.dancer(workspace, "-p", f"side:={side}") as harness:
        yield RunningDancer(harness, side)


@check(points=2, covers="program", needs=("executable",), after=("subpackages",), doc=contract.CREATE)
@hint(*HINTS)
def test_starts(running_dancer: RunningDancer) -> None:
    """`ros2 run square_dance dancer` starts a node called dancer."""
    names = running_dancer.harness.nodes()
    expect("/dancer" in names, f"/dancer is not in the graph, which contains {', '.join(names) or 'no node'}.")


@check(points=1, covers="given", needs=("executable",), after=("starts",), doc=contract.CREATE)
@hint(*HINTS)
def test_dances(workspace: Workspace, running_dancer: RunningDancer) -> None:
    """The robot drives along one side of the square, and then turns to the left."""
    robots.expect_dance(running_dancer.harness, running_dancer.side)
    with robots.dancer(workspace) as harness:
        robots.expect_dance(harness, contract.SIDE)


@check(points=1, covers="given", needs=("executable", "config"), after=("starts",), doc=contract.DEVELOP)
@hint("The configuration is given: install it unchanged.", "It sets the parameter side of the node dancer.")
def test_configured(workspace: Workspace, installed_dance: installed.Installed) -> None:
    """With the installed configuration, the robot dances a square with the side that the file sets."""
    path = installed_dance.prefix / "share" / installed_dance.package / contract.DANCE_CONFIG
    side = _side(installed_dance.read(contract.DANCE_CONFIG) or b"")
    expected = contract.CONFIGURED_SIDE
    expect(side == expected, f"The given configuration sets a side of {expected:g} m; yours sets {side:g} m.")
    with robots.dancer(workspace, "--params-file", str(path)) as harness:
        robots.expect_dance(harness, side)


def _side(text: bytes) -> float:
    with reading("The configuration"):
        try:
            side = student_yaml.load(text)["dancer"]["ros__parameters"]["side"]
        except (yaml.YAMLError, KeyError, TypeError):
            side = None
    is_usable = isinstance(side, float) and 0.1 <= side <= 5.0
    expect(
        is_usable, "The configuration does not set dancer: ros__parameters: side to a length in metres, such as 1.5."
    )
    return float(side or 0.0)
