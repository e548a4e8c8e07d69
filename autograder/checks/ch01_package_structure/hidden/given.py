"""Whether the files that came with a package are as they were: its tests notice a faulty module, the rest is unchanged.

A linter's test that `ros2 pkg create` wrote does so, too. Its test_copyright is skipped, so that one is not asked.
"""

from __future__ import annotations

import random
from dataclasses import dataclass
from pathlib import Path

from autograder.checking import Workspace, expect, solution_path
from autograder.checking.probes import fault_injection, given_files, student_test_reports, student_test_runs, versions
from autograder.checks.ch01_package_structure.support import contract

HINTS = (
    "The tests were right from the start, the linters' too: take them as they were given.",
    "A test that is skipped, or asserts nothing, finds no fault. Copy test/ from the course's folder again.",
    "The node, its helper, the launch file and the configuration were right, too: copy what you changed again.",
)
FOLDERS = ("launch", "config", "test")  # beside the module, the folders with given files
LINTERS = ("test_flake8::test_flake8", "test_pep257::test_pep257")
# What a linter's test imports. `ros2 pkg create`, by which square_dance may have been made, words them in its own way.
IMPORTED = {f"test/test_{name}.py": f"ament_{name}".encode() for name in ("copyright", "flake8", "pep257")}


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
    """Fail the check unless each given test passes on a right package, fails on a faulty one, and no file changed.

    A changed file costs half of the points.
    """
    taken = student_test_runs.take(workspace, given.package)
    files = tuple(sorted({f"{test.partition('::')[0]}.py" for test in given.tests}))
    absent = [name for name in files if name not in taken.tests]
    expect(not absent, f"test/ of {given.package} has no {' and no '.join(absent)} any more.")
    kept = {name: data for name, data in taken.files.items() if name.removeprefix("test/") in (name, *files)}
    source = student_test_reports.Source(given.package, kept)  # of test/ the given files alone
    right = versions.planted(versions.read(solution_path(given.package), {}), random.Random())
    (report,) = student_test_runs.run(workspace, source, [student_test_reports.TestRun(files, right, conftest=False)])
    failed = " and ".join(dict.fromkeys(map(student_test_reports.shown_name, report.failed)))
    expect(not failed, f"The checks ran your tests on a right {given.package}, and {failed} failed.")
    fault_injection.expect_failures(
        workspace, source, given.tests, {given.module: fault_injection.UNTIDY + given.faulty}
    )
    # The linter tests of `ros2 pkg create` may be the student's own, and so may each __init__.py.
    own = {name for name, imported in IMPORTED.items() if given is DANCE and imported in taken.files.get(name, b"")}
    changed = given_files.changed_files(
        taken.files, versions.read_files(solution_path(given.package)), (given.package, *FOLDERS)
    )
    changed = [name for name in changed if name not in own and Path(name).name != "__init__.py"]
    said = f"In {given.package}, {' and '.join(changed[:3])} should be as given, and was changed or deleted."
    expect(not changed, said, fraction=0.5)
