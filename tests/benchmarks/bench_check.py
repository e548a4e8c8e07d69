"""Measure how long students wait for `check`, on the reference of each chapter and with warm caches."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

from autograder.author.verification.mutants import write_reference
from autograder.notebook.checking import Part, run_part
from autograder.notebook.exercises import exercises
from autograder.suite import suites


def figures(assignments: Sequence[str] = ()) -> dict[str, float]:
    """Return `check.chapter_s` and `check.exercise_s`: the seconds of the slowest chapter, and of the slowest exercise.

    A first check of each chapter, which is not measured, fills the caches.

    Args:
        assignments: the chapters to check; all by default.
    """
    chapter_seconds, exercise_seconds = [], []
    with tempfile.TemporaryDirectory() as name:
        for assignment in assignments or suites.checkable_assignments():
            workspace, available = Path(name, assignment), exercises(assignment)
            write_reference(_sources(assignment), workspace)
            _seconds(Part(assignment), workspace)
            chapter_seconds.append(_seconds(Part(assignment), workspace))
            for exercise in available:
                exercise_seconds.append(_seconds(Part(assignment, exercise.name, available), workspace))
    return {
        "check.chapter_s": round(max(chapter_seconds), 2),
        "check.exercise_s": round(max(exercise_seconds), 2),
    }


def _sources(assignment: str) -> tuple[str, ...]:
    """Return the folders of a reference. Only a hidden suite names those that are not packages."""
    has_hidden_suite = assignment in suites.graded_assignments()
    return (suites.hidden if has_hidden_suite else suites.visible)(assignment).sources


def _seconds(part: Part, workspace: Path) -> float:
    start = time.monotonic()
    report = run_part(part, workspace, fresh=True)
    elapsed = time.monotonic() - start
    if not report.passed:
        raise RuntimeError(f"the reference does not pass every check:\n{report!r}")
    return elapsed
