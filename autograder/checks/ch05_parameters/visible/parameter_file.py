"""Checks of the fleet's parameter file, which ROS reads for each robot."""

from __future__ import annotations

from autograder.checking import Workspace, expect, group, hint
from autograder.checking.probes import parameters
from autograder.checks.ch05_parameters.support import contract
from autograder.checks.ch05_parameters.support.contract import PER_ROBOT, fleet_values
from autograder.checks.ch05_parameters.support.robot import Robot, fleet_path

check = group("files")


@check(points=1, covers="types", doc=contract.ARGUMENTS)
@hint("Three levels: the node or /**, then ros__parameters with two underscores, then the values; two spaces each.")
@hint("config/configured_node.yaml is an example for one node.")
def test_file(workspace: Workspace) -> None:
    """config/fleet_params.yaml is nested as ROS reads it."""
    expect(bool(parameters.read_file(fleet_path(workspace))), "It names no node.")


@check(
    points=1,
    covers=(*contract.FLEET_ROWS, "empty-field"),
    needs=("file", "starts"),
    after=("table",),
    doc=contract.ARGUMENTS,
)
@hint("Of all entries that fit a node the last one wins: /** stands first.")
@hint("A double has a point: 20.0, not 20.")
@hint("The key is the node's name, scout; its values stand under its own ros__parameters.")
def test_robots(workspace: Workspace) -> None:
    """The robots scout and porter get their own values, and for the rest what every robot has."""
    for name in PER_ROBOT:
        expected = fleet_values(name)
        with Robot.of_fleet(workspace, name) as robot:
            wrong = parameters.differences(robot.parameters.values(*expected), expected)
        expect(not wrong, f"For the robot {name}, {'; '.join(wrong)}.")


@check(points=1, covers="once", needs=("file",), after=("robots",))
@hint("Under scout and porter stands only what the table gives to them alone.")
def test_once(workspace: Workspace) -> None:
    """What every robot has stands once: no entry of one robot sets slow_distance again."""
    file = parameters.read_file(fleet_path(workspace))
    repeated_names = [name for name, values in file.items() if name != "/**" and "slow_distance" in values]
    expect(not repeated_names, f"Under {', '.join(repeated_names)}, slow_distance stands again.")
