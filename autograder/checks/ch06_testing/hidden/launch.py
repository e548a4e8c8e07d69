"""Checks that the integration test passes on a correct launched system, and fails if it breaks the contract."""

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
@hint("Find the launch file in the package's share folder, with FindPackageShare or get_package_share_directory.")
@hint("Ask over topics. Another correct program may print other words.")
def test_launch_right(examination: Examination) -> None:
    """The tests in test_launch.py pass on every correct guard.launch.py."""
    examination.expect_passed_on_correct_versions(LAUNCH)


LINES = (
    Line(
        id="configuration",
        covers="launch-promise",
        title="A test fails when the launched node does not get both distances of its configuration.",
        promise="guard.launch.py starts the node with config/guard.yaml, which has two distances.",
        points=2,
        hints=(
            "At which distance do a guard with config/guard.yaml and one with the defaults answer differently?",
            "At 0.4 m, the configuration allows a fifth of the speed: 0.8 m/s becomes 0.16 m/s (pytest.approx).",
            "Users launch the installed launch file, not the one in src: find it with FindPackageShare.",
        ),
        doc=contract.INTEGRATION,
    ),
    Line(
        id="runs",
        covers="launch-promise",
        title="A test fails when the launched node ends early, or has another name or other topics.",
        promise="guard.launch.py runs the node /speed_guard, on the topics of the contract.",
        points=2,
        hints=(
            "A launch file can be read without an error, and still start a node that ends immediately.",
            "Ask the launched node something over its topics, and require an answer within a deadline.",
            "Look for its whole name among the nodes of the domain.",
        ),
        doc=contract.INTEGRATION,
    ),
)


@check_each_row(group("launch", after=RIGHT_CHECK), LINES)
def expect_detection(line: Line, examination: Examination) -> None:
    """Fail the check unless the tests of the file fail on every version that breaks the line."""
    examination.expect_detection(line.id, line.promise)
