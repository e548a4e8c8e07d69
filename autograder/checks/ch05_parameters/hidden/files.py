"""The parameter file of the fleet: read by ROS itself, for each robot."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from autograder.checks import expect, group, hint
from autograder.checks.ch05_parameters.support import contract
from autograder.checks.ch05_parameters.support.contract import OWN, SHARED, WANTED, fleet_values
from autograder.checks.ch05_parameters.support.robot import Robot, fleet_path
from autograder.harness import Workspace
from autograder.probes.parameters import Value, differences, near_misses, read_file, shortened

check = group("files")
Entries = dict[str, dict[str, Value]]


@pytest.fixture(scope="session")
def fleet(workspace: Workspace) -> Callable[[], Entries]:
    """Read the installed file; a fixture may not fail, so the check that asks does."""
    return lambda: read_file(fleet_path(workspace))


@check(points=2, holds="types", needs=("starts",), doc=contract.ARGUMENTS)
@hint("Three levels: the node or /**, then ros__parameters with two underscores, then the values; two spaces each.")
@hint("config/configured_node.yaml is an example for one node.")
def test_file(fleet: Callable[[], Entries]) -> None:
    """config/fleet_params.yaml is installed and nested as ROS reads it."""
    expect(bool(fleet()), "It names no node.")


@check(points=1, holds="types", needs=("file",), doc=contract.PARAMETERS)
@hint("A name that no node declares is dropped without a word: compare it with the table of exercise 1.")
def test_file_names(fleet: Callable[[], Entries]) -> None:
    """The file sets declared names only."""
    names = {name for values in fleet().values() for name in values}
    unknown = sorted(names - set(WANTED))
    meant = {near: name for name, near in near_misses(WANTED, names).items() if near}
    told = [f"{shortened(name)} (you mean {meant[name]})" if name in meant else shortened(name) for name in unknown]
    expect(not unknown, f"No node declares {', '.join(told)}: it would have no effect.")


@check(
    points=2,
    holds=(*contract.FLEET_ROWS, "empty-field"),
    needs=("file_names", "overrides", "types"),
)
@hint("What every robot has stands under /**, which fits every name.")
def test_any_robot(workspace: Workspace) -> None:
    """A robot that the file does not name gets what every robot has."""
    _expect_values(workspace, "joiner")


@check(
    points=2,
    holds=(*contract.FLEET_ROWS, "empty-field"),
    needs=("file_names", "overrides", "types"),
)
@hint("Of all entries that fit a node the last one wins: /** stands first.")
@hint("The key is the node's name, scout; its values stand under its own ros__parameters.")
def test_scout(workspace: Workspace) -> None:
    """The robot scout gets its own values, and over the rest what every robot has."""
    _expect_values(workspace, "scout")


@check(
    points=2,
    holds=(*contract.FLEET_ROWS, "empty-field"),
    needs=("file_names", "overrides", "types"),
)
@hint("Of all entries that fit a node the last one wins: /** stands first.")
@hint("20.0 and 1.0 are doubles; 20 and 1 would keep the node from starting.")
def test_porter(workspace: Workspace) -> None:
    """The robot porter gets its own values, and over the rest what every robot has."""
    _expect_values(workspace, "porter")


@check(points=1, holds="once", needs=("file_names",))
@hint("A robot's entry holds only what is its own: the rest comes from /**.")
def test_stands_once(fleet: Callable[[], Entries]) -> None:
    """What every robot has stands once, under /**."""
    entries = fleet()
    everywhere = entries.get("/**", {})
    missing = sorted(set(SHARED) - set(everywhere))
    expect(not missing, f"Under /** there is no {', '.join(missing)}.")
    anybodys = {name for own in OWN.values() for name in own}  # a misspelt robot is the matter of other checks
    for key, values in entries.items():
        own = set(OWN.get(key.rpartition("/")[2], anybodys))
        again = sorted(set(values) & set(SHARED) - own) if key != "/**" else []
        expect(not again, f"Under {shortened(key)}, {', '.join(again)} stands again, which every robot has.")


def _expect_values(workspace: Workspace, name: str) -> None:
    wanted = fleet_values(name)
    with Robot.of_fleet(workspace, name) as robot:
        wrong = differences(robot.parameters.values(*wanted), wanted)
    expect(not wrong, f"For the robot {name}, {'; '.join(wrong)}.")
