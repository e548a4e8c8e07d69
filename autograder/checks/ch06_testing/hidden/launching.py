"""The integration test: does it notice when what is launched is not what was promised?"""

from __future__ import annotations

from autograder.checks import group, hint
from autograder.checks.ch06_testing.hidden.examination import SECOND, Examination
from autograder.checks.ch06_testing.support import contract
from autograder.checks.ch06_testing.support.contract import LAUNCH
from autograder.checks.ch06_testing.support.verdicts import expect_passed

check = group("launch", doc=contract.INTEGRATION)
RIGHT = ("launch_right",)


@check(points=2)
@hint(contract.SAME_DOMAIN, contract.WAIT)
def test_launch_pass(examination: Examination) -> None:
    """A test in test_launch.py runs, and passes on the package as it is."""
    expect_passed(LAUNCH, examination.trial.get(LAUNCH))


@check(points=1, depends=("launch_pass",))
@hint("Find the launch file in the package's share folder, by FindPackageShare or get_package_share_directory.")
@hint("Ask over topics; what the program prints may be worded otherwise tomorrow.")
def test_launch_right(examination: Examination) -> None:
    """It passes on every right guard.launch.py."""
    examination.expect_right(LAUNCH, SECOND)


@check(points=2, depends=RIGHT)
@hint("At which distance does a guard with config/guard.yaml answer otherwise than one with the defaults?")
@hint("At 0.4 m: the defaults say stop, the configuration does not.")
def test_configuration(examination: Examination) -> None:
    """A test fails when the launched node does not get its configuration."""
    examination.expect_objection("configuration", "guard.launch.py starts the node with config/guard.yaml.")


@check(points=2, depends=RIGHT)
@hint("A launch file that can be read has not yet started anything that lives.")
@hint("Ask the launched node something over its topics, and count on the answer within a deadline.")
def test_runs(examination: Examination) -> None:
    """A test fails when the launched node dies, or is not where the robot looks for it."""
    examination.expect_objection("runs", "guard.launch.py runs the node /speed_guard, on the topics of the contract.")
