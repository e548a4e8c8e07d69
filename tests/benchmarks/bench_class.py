"""Measure how fast this machine grades a class of different answers to 02 and 08, with warm caches."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Mapping
from pathlib import Path

from autograder.author.verification.mutants import write_reference
from autograder.grade import DEFAULT_SEED
from autograder.grade.batch import grade_all
from autograder.suite import suites

CLASSES = {"02_nodes": 6, "08_capstone": 4}  # students in each class: even numbers, for two workers
SPEED_UP_CLASS = "02_nodes"


def figures() -> dict[str, float]:
    """Return the submissions per minute with two workers, and the speed-up over one worker."""
    results = {}
    with tempfile.TemporaryDirectory() as name:
        for assignment, students in CLASSES.items():
            folder = Path(name, assignment)
            answers = {str(number): _answer(folder, assignment, number) for number in range(students)}
            _seconds({"0": answers["0"]}, assignment, folder, 1)
            elapsed = _seconds(answers, assignment, folder, 2)
            results[f"class.submissions_per_minute_{assignment[:2]}"] = round(60 * students / elapsed, 1)
            if assignment == SPEED_UP_CLASS:
                results["class.two_workers_ratio"] = round(_seconds(answers, assignment, folder, 1) / elapsed, 2)
    return results


def _answer(folder: Path, assignment: str, number: int) -> Path:
    answer = folder / str(number)
    write_reference(suites.hidden(assignment).sources, answer)
    (answer / "README").write_text(f"student {number}")  # equal answers would be graded once
    return answer


def _seconds(answers: Mapping[str, Path], assignment: str, folder: Path, jobs: int) -> float:
    start = time.monotonic()
    results = grade_all(answers, assignment, seed=DEFAULT_SEED, out=folder / "out", jobs=jobs)
    elapsed = time.monotonic() - start
    if any(result.score != result.max_score for result in results):
        raise RuntimeError(f"not every reference of {assignment} got full marks")
    return elapsed
