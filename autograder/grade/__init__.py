"""Grades a submission. A `Job` describes the task, and a `Result` its outcome.

    submission -> intake -> notebook (restored, then executed) -> build -> checks -> result

`grade_submission` starts a worker (`worker.py`) for each submission in a separate sandbox. The worker executes the
phases, and runs students' code only in sandboxes. The many submissions of the verification share a few workers.
"""

from autograder.grade.pipeline import DEFAULT_SEED, grade_submission

__all__ = ["DEFAULT_SEED", "grade_submission"]
