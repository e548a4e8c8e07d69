"""Checks that the integration test fails if the launched system breaks the contract."""

from __future__ import annotations

from autograder.checking import check_each_row, group, hint
from autograder.checks.ch06_testing.hidden.examination import Examination, Line
from autograder.checks.ch06_testing.support import contract
from autograder.checks.ch06_testing.support.assertions import expect_passed
from autograder.checks.ch06_testing.support.contract import LAUNCH

check = group("launch", doc=contract.INTEGRATION)
RIGHT_CHECK = ("launch_right",)


@check(points=2, covers="write-launch-test")
@hint(contract.SAME_DOMAIN, contract.WAIT)
def test_launch_pass(examination: Examination) -> None:
    """A test in test_launch.py runs, and passes on the package as it is."""
    expect_passed(LAUNCH, examination.trial.get(LAUNCH))


@check(points=1, covers=("write-launch-test", "launch-promise"), after=("launch_pass",))
@hint("Find the launch file in the package's share folder, by FindPackageShare or get_package_share_directory.")
@hint("Ask over topics; what the program prints may be worded otherwise tomorrow.")
def test_launch_right(examination: Examination) -> None:
    """It passes on every right guard.launch.py."""
    examination.expect_right(LAUNCH)


LINES = (
    Line(
        id="configuration",
        covers="launch-promise",
        title="A test fails when the launched node does not get both distances of its configuration.",
        promise="guard.launch.py starts the node with config/guard.yaml, which has two distances.",
        points=2,
        hints=(
            "At which distance does a guard with config/guard.yaml answer otherwise than one with the defaults?",
            "At 0.4 m, the configuration allows a fifth of the speed: asked for 0.8 m/s, 0.16 m/s and nothing else.",
            "The user launches the installed launch file, not the one in src: find it by FindPackageShare.",
        ),
        doc=contract.INTEGRATION,
    ),
    Line(
        id="runs",
        covers="launch-promise",
        title="A test fails when the launched node dies, or is not where the robot looks for it.",
        promise="guard.launch.py runs the node /speed_guard, on the topics of the contract.",
        points=2,
        hints=(
            "A launch file that can be read has not yet started anything that lives.",
            "Ask the launched node something over its topics, and count on the answer within a deadline.",
            "Look for its whole name among the nodes of the domain.",
        ),
        doc=contract.INTEGRATION,
    ),
)


@check_each_row(group("launch", after=RIGHT_CHECK), LINES)
def expect_objection(line: Line, examination: Examination) -> None:
    """Fail the check unless the tests of the file fail on every version that breaks the line."""
    examination.expect_objection(line.id, line.promise)
