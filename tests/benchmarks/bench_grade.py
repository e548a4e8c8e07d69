"""Measure how many core-seconds a grading of each chapter's reference takes, with warm caches on an idle machine."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Sequence
from pathlib import Path

from autograder.author.verification.mutants import write_reference
from autograder.grade import DEFAULT_SEED, grade_submission
from autograder.grade.job import Job
from autograder.suite import suites

CAPSTONE = "08_capstone"


def figures(assignments: Sequence[str] = ()) -> dict[str, float]:
    """Return `grade.NN_core_s` for each chapter, and their sum as `grade.all_core_s`, in core-seconds.

    `grade.capstone_core_s` is another name of the figure of 08. A first grading of each chapter, which is not measured,
    fills the caches.

    Args:
        assignments: the chapters to grade; all by default.
    """
    with tempfile.TemporaryDirectory() as name:
        costs = {assignment: _cost(Path(name), assignment) for assignment in assignments or suites.graded_assignments()}
    results = {f"grade.{assignment[:2]}_core_s": cost for assignment, cost in costs.items()}
    if CAPSTONE in costs:
        results["grade.capstone_core_s"] = costs[CAPSTONE]
    if not assignments:
        results["grade.all_core_s"] = sum(costs.values())
    return {figure: round(cost, 2) for figure, cost in results.items()}


def _cost(folder: Path, assignment: str) -> float:
    """Return the core-seconds of the second grading of a reference."""
    reference = folder / assignment
    write_reference(suites.hidden(assignment).sources, reference)
    _grade(reference, assignment, folder / "cold")
    before = _cpu_seconds()
    _grade(reference, assignment, folder / "warm")
    return _cpu_seconds() - before


def _grade(reference: Path, assignment: str, out: Path) -> None:
    result = grade_submission(Job(reference, assignment, "reference", DEFAULT_SEED, out))
    if result.score != result.max_score:
        raise RuntimeError(f"the reference of {assignment} has {result.score:g} of {result.max_score:g} points")


def _cpu_seconds() -> float:
    """Return the processor time of the whole machine, in seconds.

    A sandbox kills processes that no parent waits for, so their own times are lost.
    """
    user, nice, system, _, _, irq, softirq = map(int, Path("/proc/stat").read_text().split()[1:8])
    return (user + nice + system + irq + softirq) / os.sysconf("SC_CLK_TCK")
