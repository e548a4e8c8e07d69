"""Checks of the fleet's parameter file, which ROS reads for each robot."""

from __future__ import annotations

from autograder.checking import Workspace, expect, group, hint
from autograder.checking.probes import parameters
from autograder.checks.ch05_parameters.support import contract
from autograder.checks.ch05_parameters.support.contract import PER_ROBOT, fleet_values
from autograder.checks.ch05_parameters.support.robot import Robot, fleet_path

check = group("files")


@check(points=1, covers="types", doc=contract.ARGUMENTS)
@hint("Three levels, each indented by two spaces more: the node or /**, ros__parameters (two underscores), the values.")
@hint("config/configured_node.yaml is an example for one node.")
def test_file(workspace: Workspace) -> None:
    """config/fleet_params.yaml has the three levels that ROS reads."""
    expect(bool(parameters.read_file(fleet_path(workspace))), "config/fleet_params.yaml names no node.")


@check(
    points=1,
    covers=(*contract.FLEET_ROWS, "empty-field"),
    needs=("file", "starts"),
    after=("table",),
    doc=contract.ARGUMENTS,
)
@hint("Of all entries that fit a node, the last one wins: write /** first.")
@hint("A double has a point: 20.0, not 20.")
@hint("The key is the node's name, scout; its values are under its own ros__parameters.")
def test_robots(workspace: Workspace) -> None:
    """The robots scout and porter get their own values, and otherwise the values for every robot."""
    for name in PER_ROBOT:
        expected = fleet_values(name)
        with Robot.of_fleet(workspace, name) as robot:
            differences = parameters.differences(robot.parameters.values(*expected), expected)
        expect(not differences, f"For the robot {name}, {'; '.join(differences)}.")


@check(points=1, covers="once", needs=("file",), after=("robots",))
@hint("Under scout and porter, write only the values in their own columns of the table.")
def test_once(workspace: Workspace) -> None:
    """A value for every robot is set only once: no entry of a single robot sets slow_distance again."""
    file = parameters.read_file(fleet_path(workspace))
    repeated_names = [name for name, values in file.items() if name != "/**" and "slow_distance" in values]
    expect(not repeated_names, f"slow_distance is set again under {', '.join(repeated_names)}.")
