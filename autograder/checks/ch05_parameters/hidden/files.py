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
def read_fleet_file(workspace: Workspace) -> Callable[[], Entries]:
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
@hint("Three levels, each indented by two spaces more: the node or /**, ros__parameters (two underscores), the values.")
@hint("config/configured_node.yaml is an example for one node.")
def test_file(read_fleet_file: Callable[[], Entries]) -> None:
    """config/fleet_params.yaml is installed, and has the three levels that ROS reads."""
    expect(bool(read_fleet_file()), "config/fleet_params.yaml names no node.")


@check(points=1, covers="types", doc=contract.PARAMETERS)
@hint("ROS drops a name that no node declares, without a warning: compare the names with the table of exercise 1.")
def test_file_names(read_fleet_file: Callable[[], Entries]) -> None:
    """The file sets only parameters that the node declares."""
    names = {name for values in read_fleet_file().values() for name in values}
    undeclared_names = sorted(names - set(SPECIFICATIONS))
    intended = {near: name for name, near in parameters.near_misses(SPECIFICATIONS, names).items() if near}
    descriptions = [
        f"{parameters.shortened(name)} (did you mean {intended[name]}?)"
        if name in intended
        else parameters.shortened(name)
        for name in undeclared_names
    ]
    message = f"The file sets names that the node does not declare, so they have no effect: {', '.join(descriptions)}."
    expect(not undeclared_names, message)


@check(points=2, covers=(*contract.FLEET_ROWS, "empty-field"), after=("file_names",))
@hint("Write the values for every robot under /**, which matches every node.")
def test_any_robot(start_values: Values) -> None:
    """A robot that the file does not name gets the values for every robot."""
    differences = parameters.differences(start_values(OTHER_ROBOT), {**DEFAULTS, **SHARED})
    expect(not differences, f"For a robot with another name, {'; '.join(differences)}.")


@check(points=2, covers=(*contract.FLEET_ROWS, "empty-field"), after=("file_names", "any_robot"))
@hint("Of all entries that match a node, the last one wins: write /** first.")
@hint("The key is the node's name, scout; its values are under its own ros__parameters.")
def test_scout(start_values: Values) -> None:
    """The robot scout gets its own values, and otherwise the values for every robot."""
    _expect_values(start_values, "scout")


@check(points=2, covers=(*contract.FLEET_ROWS, "empty-field"), after=("file_names", "any_robot"))
@hint("Of all entries that match a node, the last one wins: write /** first.")
@hint("20.0 and 1.0 are doubles. With 20 or 1, the node would not start.")
def test_porter(start_values: Values) -> None:
    """The robot porter gets its own values, and otherwise the values for every robot."""
    _expect_values(start_values, "porter")


@check(points=1, covers="once", after=("file_names", "any_robot"))
@hint("A robot's entry contains only its own values: the others come from /**.")
def test_stands_once(read_fleet_file: Callable[[], Entries]) -> None:
    """The values for every robot are set only once, under /**."""
    entries = read_fleet_file()
    shared_names = set(entries.get("/**", {})) & set(SHARED)
    expect(bool(shared_names), "/** sets none of the values for every robot.")
    # Robots start correctly without these values, which equal the defaults; `any_robot` reports any others.
    missing_names = sorted({name for name, value in SHARED.items() if value == DEFAULTS[name]} - shared_names)
    message = f"/** does not set {', '.join(missing_names)}: set every value there, because a default may change."
    expect(not missing_names, message)
    names_of_any = {name for values in PER_ROBOT.values() for name in values}  # other checks report a misspelt robot
    for key, values in entries.items():
        allowed_names = set(PER_ROBOT.get(key.rpartition("/")[2], names_of_any))
        repeated_names = sorted(set(values) & set(SHARED) - allowed_names) if key != "/**" else []
        expect(
            not repeated_names,
            f"{parameters.shortened(key)} sets {', '.join(repeated_names)}, which only /** should set.",
        )


def _expect_values(start_values: Values, name: str) -> None:
    """Fail the check unless a robot has its own values and, for the rest, those of the exercise or of any robot."""
    values = start_values(name)
    differences = parameters.differences(values, fleet_values(name)) and parameters.differences(
        values, {**start_values(OTHER_ROBOT), **PER_ROBOT[name]}
    )
    expect(not differences, f"For the robot {name}, {'; '.join(differences)}.")


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
            raise CheckFailed(f"With config/{contract.FLEET}, no node called {name} starts: {error}")
    return {
        name: DEFAULTS | {key: outcomes[step].value for key, step in steps.items() if not outcomes[step].raised}
        for name, steps in value_steps.items()
    }
