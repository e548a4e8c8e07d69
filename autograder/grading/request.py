"""What is asked for each submission of a class, and the stored result that may answer it."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from autograder import intake
from autograder.checks import suites
from autograder.exceptions import AutograderError
from autograder.grading.pipeline import RESULT, grade_submission
from autograder.result import Result, Status, from_json
from autograder.sandbox import Tier


@dataclass(frozen=True)
class Request:
    """One submission of a class to grade.

    Attributes:
        student: whose it is.
        path: where it lies.
        assignment: which assignment it answers.
        seed: every hidden input is drawn from it.
        isolation: the sandbox's tier.
        out: the folder that gets its result and pictures.
        resume: whether a stored result counts.
    """

    student: str
    path: Path
    assignment: str
    seed: int
    isolation: Tier
    out: Path
    resume: bool = False

    def stored(self) -> Result | None:
        """Return the stored result if it may be kept: its submission, suite, seed and isolation are the same."""
        if not self.resume:
            return None
        try:
            result = from_json(json.loads((self.out / RESULT).read_text()), source=str(self.out / RESULT))
            digest = intake.read_submission(self.path, self.assignment).sha256
        except (OSError, ValueError, AutograderError):
            return None
        suite = suites.hidden(self.assignment)
        found = (result.submission_sha256, result.suite_version, result.seed, result.isolation)
        same = found == (digest, suite.version, self.seed, self.isolation.value)
        return result if same and result.status is Status.GRADED else None

    def grade(self) -> Result:
        """Grade the submission on this machine."""
        return grade_submission(
            self.path,
            self.assignment,
            student=self.student,
            seed=self.seed,
            out=self.out,
            isolation=self.isolation,
        )
