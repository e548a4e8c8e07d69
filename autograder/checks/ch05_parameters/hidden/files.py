"""Checks of the fleet's parameter file: ROS reads it for each robot, and the student's node does not run."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from autograder.checking import CheckFailed, Workspace, expect, group, hint
from autograder.checking.probes import calls, parameters
from autograder.checks.ch05_parameters.support import contract
from autograder.checks.ch05_parameters.support.contract import DEFAULTS, PER_ROBOT, SHARED, SPECIFICATIONS, fleet_values
from autograder.checks.ch05_parameters.support.robot import fleet_path

check = group("files", needs=("file",))
OTHER_ROBOT = "joiner"  # a robot that the file does not name
Entries = dict[str, dict[str, parameters.Value]]
Values = Callable[[str], dict[str, parameters.Value]]


@pytest.fixture(scope="session")
def fleet(workspace: Workspace) -> Callable[[], Entries]:
    """A function that reads the installed file, so that an error fails the check and not the fixture."""
    return lambda: parameters.read_file(fleet_path(workspace))


@pytest.fixture(scope="session")
def start_values(workspace: Workspace) -> Values:
    """A function that maps a robot's name to its start values: the table's defaults, overridden by the file."""
    by_robot: dict[str, dict[str, parameters.Value]] = {}

    def values(name: str) -> dict[str, parameters.Value]:
        by_robot.update(by_robot or _start_values(workspace, (OTHER_ROBOT, *PER_ROBOT)))
        return by_robot[name]

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
    unknown = sorted(names - set(SPECIFICATIONS))
    intended = {near: name for name, near in parameters.near_misses(SPECIFICATIONS, names).items() if near}
    descriptions = [
        f"{parameters.shortened(name)} (you mean {intended[name]})" if name in intended else parameters.shortened(name)
        for name in unknown
    ]
    expect(not unknown, f"No node declares {', '.join(descriptions)}: it would have no effect.")


@check(points=2, covers=(*contract.FLEET_ROWS, "empty-field"), after=("file_names",))
@hint("What every robot has stands under /**, which fits every name.")
def test_any_robot(start_values: Values) -> None:
    """A robot that the file does not name gets what every robot has."""
    wrong = parameters.differences(start_values(OTHER_ROBOT), {**DEFAULTS, **SHARED})
    expect(not wrong, f"For a robot of another name, {'; '.join(wrong)}.")


@check(points=2, covers=(*contract.FLEET_ROWS, "empty-field"), after=("file_names", "any_robot"))
@hint("Of all entries that fit a node the last one wins: /** stands first.")
@hint("The key is the node's name, scout; its values stand under its own ros__parameters.")
def test_scout(start_values: Values) -> None:
    """The robot scout gets its own values, and over the rest what every robot has."""
    _expect_values(start_values, "scout")


@check(points=2, covers=(*contract.FLEET_ROWS, "empty-field"), after=("file_names", "any_robot"))
@hint("Of all entries that fit a node the last one wins: /** stands first.")
@hint("20.0 and 1.0 are doubles; 20 and 1 would keep the node from starting.")
def test_porter(start_values: Values) -> None:
    """The robot porter gets its own values, and over the rest what every robot has."""
    _expect_values(start_values, "porter")


@check(points=1, covers="once", after=("file_names", "any_robot"))
@hint("A robot's entry holds only what is its own: the rest comes from /**.")
def test_stands_once(fleet: Callable[[], Entries]) -> None:
    """What every robot has stands once, under /**."""
    entries = fleet()
    shared_names = set(entries.get("/**", {})) & set(SHARED)
    expect(bool(shared_names), "Under /** there is nothing that every robot has.")
    # Robots start correctly without these values, which equal the defaults; `any_robot` reports any others.
    missing_names = sorted({name for name, value in SHARED.items() if value == DEFAULTS[name]} - shared_names)
    message = f"{', '.join(missing_names)}, which every robot has, does not stand under /**"
    expect(not missing_names, f"{message}: a default of the declaration may change.")
    names_of_any = {name for values in PER_ROBOT.values() for name in values}  # other checks report a misspelt robot
    for key, values in entries.items():
        allowed_names = set(PER_ROBOT.get(key.rpartition("/")[2], names_of_any))
        repeated_names = sorted(set(values) & set(SHARED) - allowed_names) if key != "/**" else []
        expect(
            not repeated_names,
            f"{', '.join(repeated_names)}, which every robot has, stands under {parameters.shortened(key)}.",
        )


def _expect_values(start_values: Values, name: str) -> None:
    """Fail the check unless a robot has its own values and, for the rest, those of the exercise or of any robot."""
    values = start_values(name)
    wrong = parameters.differences(values, fleet_values(name)) and parameters.differences(
        values, {**start_values(OTHER_ROBOT), **PER_ROBOT[name]}
    )
    expect(not wrong, f"For the robot {name}, {'; '.join(wrong)}.")


def _start_values(workspace: Workspace, names: tuple[str, ...]) -> dict[str, dict[str, parameters.Value]]:
    """Return the values with which nodes of these names would start if they declared the parameters of exercise 1.

    Raises:
        CheckFailed: ROS cannot read the file.
    """
    plan = calls.Plan()
    plan.add(calls.call("init"))
    path = str(fleet_path(workspace))
    options: dict[str, Any] = {
        "cli_args": ["--ros-args", "--params-file", path],
        "automatically_declare_parameters_from_overrides": True,
    }
    nodes = {name: plan.add(calls.call("Node", name, module="rclpy.node", **options)) for name in names}
    value_steps: dict[str, dict[str, int]] = {}
    for name, node in nodes.items():
        steps = {parameter: plan.add(calls.call("get_parameter", parameter, on=node)) for parameter in SPECIFICATIONS}
        value_steps[name] = {
            parameter: plan.add(calls.attribute("value", on=step)) for parameter, step in steps.items()
        }
    outcomes = calls.run_steps(workspace, "rclpy", *plan.steps, network=True)
    for name, node in nodes.items():
        if outcomes[node].raised:
            error = parameters.shortened(outcomes[node].message)
            raise CheckFailed(f"With config/{contract.FLEET}, no node of the name {name} starts: {error}")
    return {
        name: DEFAULTS | {key: outcomes[step].value for key, step in steps.items() if not outcomes[step].raised}
        for name, steps in value_steps.items()
    }
