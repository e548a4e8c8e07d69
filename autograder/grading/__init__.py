"""Grading: from what was handed in to a result.

    submission -> intake -> notebook (hygiene, extract) -> build -> checks -> result

`grade_submission` starts a worker for one submission in a cell of its own; the worker (`worker.py`) goes through the
phases, running students' code in sandboxes only. The proof's many submissions share a few workers (`lanes.py`).
"""

from autograder.grading.pipeline import DEFAULT_SEED, Graded, grade_submission

__all__ = ["DEFAULT_SEED", "Graded", "grade_submission"]
