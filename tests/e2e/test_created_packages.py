"""Packages created by `ros2 pkg create` and completed with a student's work get full marks.

The tool is the stand-in, or the real one after `make real-launch`. Both must write the same files, which
`python -m tests.e2e.created_packages` recorded in created_packages.yaml with the real ros2cli.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml

from autograder.author.verification.cases import Case
from autograder.author.verification.mutants import write_reference
from autograder.author.verification.verdicts import CaseKind, verify_full_marks
from autograder.author.verification.verify_cases import verify_cases
from autograder.author.verification.worker_pool import WorkerPool
from autograder.run.sandbox import Isolation
from autograder.suite import suites
from tests.e2e.created_packages import RECORD, create, facts, fill_in, lines_of

# The packages of each chapter that a student could create with the tool.
PACKAGES = {
    "01_package_structure": ("square_dance",),
    "06_testing": ("speed_guard",),
    "08_capstone": ("robot_navigation_tutorial", "robot_navigation_interfaces"),
    "09_assessment": ("motor_guard", "motor_guard_interfaces"),
}
NIGHTLY = ("06_testing", "08_capstone")  # their complete gradings take the longest
# Folders in these packages that students get with the chapter and do not change.
GIVEN = {"06_testing": ("speed_guard",)}


@pytest.fixture(scope="module")
def workers() -> Iterator[WorkerPool]:
    with WorkerPool(Isolation.BUBBLEWRAP, 1) as worker:
        yield worker


def test_pkg_create_writes_the_files_of_the_record(tmp_path: Path) -> None:
    assert facts(tmp_path) == yaml.safe_load(RECORD.read_text())


@pytest.mark.slow
@pytest.mark.timeout(600)
@pytest.mark.parametrize(
    "assignment", [pytest.param(name, marks=pytest.mark.nightly) if name in NIGHTLY else name for name in PACKAGES]
)
def test_no_check_deducts_a_point_for_a_file_that_pkg_create_wrote(
    assignment: str, workers: WorkerPool, tmp_path: Path
) -> None:
    def write(folder: Path) -> None:
        write_reference(suites.hidden(assignment).sources, folder)
        for package in PACKAGES[assignment]:
            created = create(tmp_path / "created", package)
            fill_in(created, folder / "src" / package, GIVEN.get(assignment, ()))
            assert lines_of(created) <= lines_of(folder / "src" / package)

    case = Case(assignment, CaseKind.VARIANT, "created", write, verify_full_marks)
    (verdict,) = verify_cases([case], seed=2026, out=tmp_path / "verification", workers=workers)
    messages = [f"{check.id}: {check.points:g} points. {check.message}" for check in verdict.result.checks]
    assert verdict.is_expected, "\n".join(messages)
