"""Packages that `ros2 pkg create` wrote, with a student's own work filled in, have every point of the course.

The tool is the stand-in, or after `make real-launch` the real one. What both write is recorded in
created_packages.yaml, by `python -m tests.e2e.created_packages` with the real ros2cli.
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
from tests.e2e.created_packages import RECORD, create, facts, fill_in, written

# The packages of a chapter that its student could make by the tool.
MADE = {
    "01_package_structure": ("square_dance",),
    "06_testing": ("speed_guard",),
    "08_capstone": ("robot_navigation_tutorial", "robot_navigation_interfaces"),
    "09_assessment": ("motor_guard", "motor_guard_interfaces"),
}
# The folders of these packages that a chapter gives: its student leaves them alone.
GIVEN = {"06_testing": ("speed_guard",)}


@pytest.fixture(scope="module")
def workers() -> Iterator[WorkerPool]:
    with WorkerPool(Isolation.BUBBLEWRAP, 1) as worker:
        yield worker


def test_pkg_create_writes_the_files_of_the_record(tmp_path: Path) -> None:
    assert facts(tmp_path) == yaml.safe_load(RECORD.read_text())


@pytest.mark.slow
@pytest.mark.timeout(600)
@pytest.mark.parametrize("assignment", MADE)
def test_no_check_deducts_a_point_for_a_file_that_pkg_create_wrote(
    assignment: str, workers: WorkerPool, tmp_path: Path
) -> None:
    def write(folder: Path) -> None:
        write_reference(suites.hidden(assignment).sources, folder)
        for package in MADE[assignment]:
            made = create(tmp_path / "made", package)
            fill_in(made, folder / "src" / package, GIVEN.get(assignment, ()))
            assert written(made) <= written(folder / "src" / package)

    case = Case(assignment, CaseKind.VARIANT, "created", write, verify_full_marks)
    (verdict,) = verify_cases([case], seed=2026, out=tmp_path / "verification", workers=workers)
    messages = [f"{check.id}: {check.points:g} points. {check.message}" for check in verdict.result.checks]
    assert verdict.is_expected, "\n".join(messages)
