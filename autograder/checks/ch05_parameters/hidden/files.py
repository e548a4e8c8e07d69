"""The parameter file of the fleet: read by ROS itself, for each robot, without the student's node."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from autograder.checking import CheckFailed, Workspace, expect, group, hint
from autograder.checking.probes import calls, parameters
from autograder.checks.ch05_parameters.support import contract
from autograder.checks.ch05_parameters.support.contract import DEFAULTS, OWN, SHARED, WANTED, fleet_values
from autograder.checks.ch05_parameters.support.robot import fleet_path

check = group("files", needs=("file",))
JOINER = "joiner"  # a robot that no file names
Entries = dict[str, dict[str, parameters.Value]]
Values = Callable[[str], dict[str, parameters.Value]]


@pytest.fixture(scope="session")
def fleet(workspace: Workspace) -> Callable[[], Entries]:
    """Read the installed file; a fixture may not fail, so the check that asks does."""
    return lambda: parameters.read_file(fleet_path(workspace))


@pytest.fixture(scope="session")
def start_values(workspace: Workspace) -> Values:
    """Return what ROS reads from the file for a robot of this name, over the defaults of the table."""
    found: dict[str, dict[str, parameters.Value]] = {}

    def values(name: str) -> dict[str, parameters.Value]:
        found.update(found or _start_values(workspace, (JOINER, *OWN)))
        return found[name]

    return values


@check(points=2, covers="types", needs=(), doc=contract.ARGUMENTS)
@hint("Three levels: the node or /**, then ros__parameters with two underscores, then the values; two spaces each.")
@hint("config/configured_node.yaml is an example for one node.")
def test_file(fleet: Callable[[], Entries]) -> None:
    """config/fleet_params.yaml is installed and nested as ROS reads it."""
    expect(bool(fleet()), "It names no node.")


@check(points=1, covers="types", doc=contract.PARAMETERS)
@hint("A name that no node declares is dropped without a word: compare it with the table of exercise 1.")
def test_file_names(fleet: Callable[[], Entries]) -> None:
    """The file sets declared names only."""
    names = {name for values in fleet().values() for name in values}
    unknown = sorted(names - set(WANTED))
    meant = {near: name for name, near in parameters.near_misses(WANTED, names).items() if near}
    told = [
        f"{parameters.shortened(name)} (you mean {meant[name]})" if name in meant else parameters.shortened(name)
        for name in unknown
    ]
    expect(not unknown, f"No node declares {', '.join(told)}: it would have no effect.")


@check(points=2, covers=(*contract.FLEET_ROWS, "empty-field"), after=("file_names",))
@hint("What every robot has stands under /**, which fits every name.")
def test_any_robot(start_values: Values) -> None:
    """A robot that the file does not name gets what every robot has."""
    wrong = parameters.differences(start_values(JOINER), {**DEFAULTS, **SHARED})
    expect(not wrong, f"For a robot of another name, {'; '.join(wrong)}.")


@check(points=2, covers=(*contract.FLEET_ROWS, "empty-field"), after=("file_names", "any_robot"))
@hint("Of all entries that fit a node the last one wins: /** stands first.")
@hint("The key is the node's name, scout; its values stand under its own ros__parameters.")
def test_scout(start_values: Values) -> None:
    """The robot scout gets its own values, and over the rest what every robot has."""
    _expect_own(start_values, "scout")


@check(points=2, covers=(*contract.FLEET_ROWS, "empty-field"), after=("file_names", "any_robot"))
@hint("Of all entries that fit a node the last one wins: /** stands first.")
@hint("20.0 and 1.0 are doubles; 20 and 1 would keep the node from starting.")
def test_porter(start_values: Values) -> None:
    """The robot porter gets its own values, and over the rest what every robot has."""
    _expect_own(start_values, "porter")


@check(points=1, covers="once", after=("file_names", "any_robot"))
@hint("A robot's entry holds only what is its own: the rest comes from /**.")
def test_stands_once(fleet: Callable[[], Entries]) -> None:
    """What every robot has stands once, under /**."""
    entries = fleet()
    everywhere = set(entries.get("/**", {})) & set(SHARED)
    expect(bool(everywhere), "Under /** there is nothing that every robot has.")
    # Without these, robots start as they should; of the other values, `any_robot` says that they are missing.
    absent = sorted({name for name, value in SHARED.items() if value == DEFAULTS[name]} - everywhere)
    said = f"{', '.join(absent)}, which every robot has, does not stand under /**"
    expect(not absent, f"{said}: a default of the declaration may change.")
    anybodys = {name for own in OWN.values() for name in own}  # a misspelt robot is the matter of other checks
    for key, values in entries.items():
        own = set(OWN.get(key.rpartition("/")[2], anybodys))
        again = sorted(set(values) & set(SHARED) - own) if key != "/**" else []
        expect(not again, f"{', '.join(again)}, which every robot has, stands under {parameters.shortened(key)}.")


def _expect_own(start_values: Values, name: str) -> None:
    """Fail the check unless a robot has its own values, and for the rest those of the table or of any other robot."""
    found = start_values(name)
    wrong = parameters.differences(found, fleet_values(name)) and parameters.differences(
        found, {**start_values(JOINER), **OWN[name]}
    )
    expect(not wrong, f"For the robot {name}, {'; '.join(wrong)}.")


def _start_values(workspace: Workspace, names: tuple[str, ...]) -> dict[str, dict[str, parameters.Value]]:
    """Ask ROS what nodes of these names would start with, were they to declare the table of exercise 1.

    Raises:
        CheckFailed: ROS does not read the file.
    """
    plan = calls.Plan()
    plan.add(calls.call("init"))
    path = str(fleet_path(workspace))
    options: dict[str, Any] = {
        "cli_args": ["--ros-args", "--params-file", path],
        "automatically_declare_parameters_from_overrides": True,
    }
    nodes = {name: plan.add(calls.call("Node", name, module="rclpy.node", **options)) for name in names}
    asked: dict[str, dict[str, int]] = {}
    for name, node in nodes.items():
        set_there = {parameter: plan.add(calls.call("get_parameter", parameter, on=node)) for parameter in WANTED}
        asked[name] = {parameter: plan.add(calls.look("value", on=number)) for parameter, number in set_there.items()}
    outcomes = calls.calls(workspace, "rclpy", *plan.steps, network=True)
    for name, node in nodes.items():
        if outcomes[node].raised:
            said = parameters.shortened(outcomes[node].message)
            raise CheckFailed(f"With config/{contract.FLEET}, no node of the name {name} starts: {said}")
    return {
        name: DEFAULTS | {key: outcomes[number].value for key, number in own.items() if not outcomes[number].raised}
        for name, own in asked.items()
    }
