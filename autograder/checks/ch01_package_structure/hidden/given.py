"""Whether the tests that came with a package are as they were: they fail when a module of the package is faulty.

A linter's test that `ros2 pkg create` wrote does so, too. Its test_copyright is skipped, so that one is not asked.
"""

from __future__ import annotations

from dataclasses import dataclass

from autograder.checks import expect
from autograder.checks.ch01_package_structure.support import contract
from autograder.harness import Workspace
from autograder.probes import test_runs
from autograder.probes.test_reports import ClaimedOutcome, TestRun
from autograder.probes.versions import Version

# What flake8 objects to, and pep257: a name that nothing uses, and a docstring that is no sentence.
UNTIDY = '"""no sentence"""\n\nimport os\n\n\n'
LINTERS = ("test_flake8::test_flake8", "test_pep257::test_pep257")


@dataclass(frozen=True)
class Given:
    """The tests that came with a package, and the module in which a fault is laid.

    Attributes:
        package: the package's name.
        module: the module's path below the package's folder.
        faulty: the text of the function in it that answers wrongly, whatever it is asked.
        tests: each given test, without its parameters.
    """

    package: str
    module: str
    faulty: str
    tests: tuple[str, ...]


DANCE = Given(
    contract.SQUARE_DANCE,
    "square_dance/utils/steps.py",
    "def step_at(seconds, side):\n    return 1.0, 0.0\n",
    (
        *LINTERS,
        "test_steps::test_four_sides_and_four_turns_come_back_to_the_start",
        "test_steps::test_it_drives_straight_first_and_then_turns_to_the_left",
    ),
)
ALARM = Given(
    contract.WALL_ALARM,
    "wall_alarm/utils/nearest.py",
    "def nearest(scan):\n    return 0.1\n",
    (*LINTERS, "test_nearest::test_the_nearest_reading_that_counts_is_returned"),
)


def expect_given_tests(workspace: Workspace, given: Given) -> None:
    """Fail the check unless each given test fails on a copy of the package with a faulty module."""
    source = test_runs.take(workspace, given.package)
    files = sorted({f"{test.partition('::')[0]}.py" for test in given.tests})
    absent = [name for name in files if name not in source.tests]
    expect(not absent, f"test/ of {given.package} has no {' and no '.join(absent)} any more.")
    texts = {name: data.decode(errors="replace") for name, data in source.files.items()}
    own = {name: text for name, text in texts.items() if not name.startswith("test/")}
    faulty = Version({**own, given.module: UNTIDY + given.faulty}, {})
    (report,) = test_runs.run(workspace, source, [TestRun(tuple(files), faulty)])
    said = [(name.partition("[")[0], verdict) for name, verdict in report.claims.verdicts.items()]
    for test in given.tests:
        verdicts = {verdict for name, verdict in said if name == test}
        how = "was skipped" if ClaimedOutcome.SKIPPED in verdicts else "passed" if verdicts else "did not run"
        saw = f"The checks put a fault into {given.module} of a copy of your package"
        expect(verdicts == {ClaimedOutcome.FAILED}, f"{saw}, and {test.partition('::')[2]} {how}.")
