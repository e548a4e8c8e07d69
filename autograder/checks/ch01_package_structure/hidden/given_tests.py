"""Tests the given files of a package: its tests still detect a faulty module, and the other files are unchanged.

The linter tests that `ros2 pkg create` writes are also accepted. Because it writes test_copyright as a skipped test,
the checks do not require that test.
"""

from __future__ import annotations

import random
from dataclasses import dataclass
from pathlib import Path

from autograder.checking import Workspace, expect, solution_path
from autograder.checking.probes import fault_injection, given_files, student_test_reports, student_test_runs, versions
from autograder.checks.ch01_package_structure.support import contract

HINTS = (
    "The given tests, including the linter tests, were correct: use them unchanged.",
    "A test that is skipped, or asserts nothing, finds no fault. Copy test/ from the course's folder again.",
    "The node, its helper, the launch file and the configuration were correct, too. Restore each one that you changed.",
)
FOLDERS = ("launch", "config", "test")  # the folders with given files, in addition to the module's folder
LINTERS = ("test_flake8::test_flake8", "test_pep257::test_pep257")
# The import that identifies each linter test. `ros2 pkg create`, which may have created square_dance, writes a
# different text around it.
LINTER_IMPORTS = {f"test/test_{name}.py": f"ament_{name}".encode() for name in ("copyright", "flake8", "pep257")}


@dataclass(frozen=True)
class GivenTests:
    """The tests that are given with a package, and the module into which a fault is put.

    Attributes:
        package: the package's name.
        module: the module's path below the package's folder.
        faulty_code: the text of the module's function with a fault: it always returns the same wrong value.
        tests: the names of the given tests, without parameters.
    """

    package: str
    module: str
    faulty_code: str
    tests: tuple[str, ...]


DANCE = GivenTests(
    contract.SQUARE_DANCE,
    "square_dance/utils/steps.py",
    "def step_at(seconds, side):\n    return 1.0, 0.0\n",
    (
        *LINTERS,
        "test_steps::test_four_sides_and_four_turns_come_back_to_the_start",
        "test_steps::test_it_drives_straight_first_and_then_turns_to_the_left",
    ),
)
ALARM = GivenTests(
    contract.WALL_ALARM,
    "wall_alarm/utils/nearest.py",
    "def nearest(scan):\n    return 0.1\n",
    (*LINTERS, "test_nearest::test_the_nearest_reading_that_counts_is_returned"),
)


def expect_given_tests(workspace: Workspace, case: GivenTests) -> None:
    """Fail the check unless each given test passes on a correct package and fails on a faulty one.

    A change of any other given file costs half of the points.
    """
    submitted_source = student_test_runs.read_source(workspace, case.package)
    files = tuple(sorted({f"{test.partition('::')[0]}.py" for test in case.tests}))
    absent_names = [name for name in files if name not in submitted_source.tests]
    expect(not absent_names, f"test/ of {case.package} no longer contains {' or '.join(absent_names)}.")
    sources = {
        name: data for name, data in submitted_source.files.items() if name.removeprefix("test/") in (name, *files)
    }
    source = student_test_reports.Source(case.package, sources)  # whose folder test contains only the given files
    reference = versions.with_markers(versions.read(solution_path(case.package), {}), random.Random())
    (report,) = student_test_runs.run(
        workspace, source, [student_test_reports.TestRun(files, reference, conftest=False)]
    )
    failed_names = " and ".join(dict.fromkeys(map(student_test_reports.shown_name, report.failed)))
    expect(not failed_names, f"The checks ran your tests on a correct {case.package}, and {failed_names} failed.")
    fault_injection.expect_failures(
        workspace, source, case.tests, {case.module: fault_injection.UNTIDY + case.faulty_code}
    )
    # The linter tests may be those that `ros2 pkg create` wrote for the student, and each __init__.py may differ.
    own_linter_tests = {
        name
        for name, import_text in LINTER_IMPORTS.items()
        if case is DANCE and import_text in submitted_source.files.get(name, b"")
    }
    changed_names = given_files.changed_files(
        submitted_source.files, versions.read_files(solution_path(case.package)), (case.package, *FOLDERS)
    )
    changed_names = [
        name for name in changed_names if name not in own_linter_tests and Path(name).name != "__init__.py"
    ]
    message = f"In {case.package}, these given files were changed or deleted: {', '.join(changed_names[:3])}."
    expect(not changed_names, message, fraction=0.5)
