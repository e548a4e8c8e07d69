"""What was handed in, as far as it is known before it is graded. Where root asks, another user reads it, in a cell.

python -m autograder.grade.digests PATH ASSIGNMENT
"""

from __future__ import annotations

import json
import os
import sys
from dataclasses import asdict, dataclass
from pathlib import Path

from autograder import layout
from autograder.exceptions import AutograderError
from autograder.result.model import structure
from autograder.run.sandbox import Tier
from autograder.run.sandbox.cell import run_in_cell
from autograder.run.sandbox.limits import READING_CELL
from autograder.run.sandbox.spec import View
from autograder.submission import intake


@dataclass(frozen=True)
class Digests:
    """The digests of a submission, in hexadecimal digits, and what a result says of its files."""

    sha256: str  # of all its files
    graded_sha256: str  # of what a grading reads of them
    notices: tuple[str, ...] | None  # about what counts; None if its notebook decides that
    unused: tuple[str, ...]  # files that play no part


def read_digests(path: Path, assignment: str, tier: Tier) -> Digests | None:
    """Return the digests of a submission, None if it cannot be read."""
    if os.geteuid() != 0 or tier is not Tier.BUBBLEWRAP or not path.exists():
        return _read(path, assignment)
    path = path.resolve()
    command = [sys.executable, "-m", "autograder.grade.digests", str(path), assignment]
    chapter = layout.CHAPTERS / assignment  # a course directory of nbgrader may have others
    view = View(shown=(chapter,) if chapter.is_dir() else (), submitted=(path,))
    report = run_in_cell(lambda scratch: command, tier, READING_CELL, view=view)
    lines = report.output.splitlines()
    if report.returncode != 0 or not lines:
        return None
    found: Digests = structure(Digests, json.loads(lines[-1]))
    return found


def _read(path: Path, assignment: str) -> Digests | None:
    try:
        submission = intake.read_submission(path, assignment)
    except (OSError, AutograderError):
        return None
    notices = None if submission.packages is None else submission.notices
    return Digests(submission.sha256, submission.graded_sha256, notices, submission.unused)


def main() -> None:
    """Print the digests of the submission that the command line names; end with 1 if it cannot be read."""
    found = _read(Path(sys.argv[1]), sys.argv[2])
    if found is None:
        sys.exit(1)
    print(json.dumps(asdict(found)))


if __name__ == "__main__":
    main()
