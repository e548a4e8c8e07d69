"""Reads a submission before it is graded. If the grader runs as root, another user reads it, in a worker sandbox.

python -m autograder.grade.isolated_reader READER PATH ASSIGNMENT
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from autograder import course_paths
from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import AutograderError, StudentError
from autograder.grade.bounded_json import RESULT_VALUES, read_json
from autograder.plain_text import clean
from autograder.result.model import structure
from autograder.run.sandbox import Isolation
from autograder.run.sandbox.limits import READING_WORKER
from autograder.run.sandbox.spec import View
from autograder.run.sandbox.worker_sandbox import run_in_worker_sandbox
from autograder.submission import intake
from autograder.submission.intake import Submission
from autograder.submission.intake.notebooks import read_cells

MAX_CODE = 200_000  # characters of Python code that may leave the worker sandbox


@dataclass(frozen=True)
class Digests:
    """The hexadecimal digests of a submission, and what the result says about its files."""

    sha256: str  # digest of all files
    graded_sha256: str  # digest of the content that a grading reads
    notices: tuple[str, ...] | None  # sentences about the files that count; None if the notebook has to run first
    unused: tuple[str, ...]  # files that are not graded


@dataclass(frozen=True)
class Preview:
    """The part of a submission that counts."""

    files: int | None  # the number of files in packages; None if the notebook has to run first
    notices: tuple[str, ...]  # sentences about the files that count
    unused: tuple[str, ...]  # files that are not graded


def read_digests(path: Path, assignment: str, isolation: Isolation) -> Digests | None:
    """Return the digests of a submission, or None if it cannot be read."""
    try:
        digests: Digests = structure(Digests, _read("digests", path, assignment, isolation))
    except (OSError, AutograderError):
        return None
    return digests


def read_preview(path: Path, assignment: str, isolation: Isolation) -> Preview:
    """Return the part of a submission that counts. Raise a StudentError if it is unclear or cannot be read."""
    preview: Preview = structure(Preview, _read("preview", path, assignment, isolation))
    return preview


def read_code(path: Path, assignment: str, isolation: Isolation) -> str:
    """Return the Python code of a submission, up to `MAX_CODE` characters. Raise a StudentError if unreadable."""
    return str(_read("code", path, assignment, isolation))


def code(submission: Submission) -> str:
    """Return the Python code of a submission: its modules and the code cells of its notebook."""
    texts = [f"# {file.path}\n{_text(file.data)}" for file in submission.source if file.path.suffix == ".py"]
    if submission.notebook is not None:
        with suppress(ValueError):  # the modules are returned even if the notebook cannot be read
            texts += [cell["source"] for cell in read_cells(submission.notebook) if cell["cell_type"] == "code"]
    return clean("\n".join(texts))


def _text(data: bytes) -> str:
    return data.decode("utf-8", errors="replace")


def _digests(submission: Submission) -> dict[str, Any]:
    notices = None if submission.packages is None else submission.notices
    return asdict(Digests(submission.sha256, submission.graded_sha256, notices, submission.unused))


def _preview(submission: Submission) -> dict[str, Any]:
    files = None if submission.packages is None else len(submission.packages)
    return asdict(Preview(files, submission.notices, submission.unused))


READERS: dict[str, Callable[[Submission], Any]] = {
    "digests": _digests,
    "preview": _preview,
    "code": lambda submission: code(submission)[:MAX_CODE],
}


def _read(reader: str, path: Path, assignment: str, isolation: Isolation) -> Any:
    # An ordinary user reads submissions in this process. Intake executes nothing and limits its own time and memory.
    # A worker sandbox takes half a second, fifty times as long as reading, and a class is read before it is graded.
    if os.geteuid() == 0 and isolation is Isolation.BUBBLEWRAP and path.exists():
        return _in_worker_sandbox(reader, path.resolve(), assignment)
    return READERS[reader](intake.read_submission(path, assignment))


def _in_worker_sandbox(reader: str, path: Path, assignment: str) -> Any:
    command = [sys.executable, "-m", "autograder.grade.isolated_reader", reader, str(path), assignment]
    chapter = course_paths.CHAPTERS / assignment  # an nbgrader course may have assignments that are not chapters
    view = View(shown=(chapter,) if chapter.is_dir() else (), submitted=(path,))
    report = run_in_worker_sandbox(lambda scratch: command, Isolation.BUBBLEWRAP, READING_WORKER, view=view)
    try:
        answer = read_json(report.output.rpartition("\n")[2].encode(), RESULT_VALUES)
        if "refused" in answer:
            raise StudentError(structure(Diagnosis, answer["refused"]))
        return answer["read"]
    except (LookupError, ValueError, RecursionError, TypeError, AttributeError):
        sentence = f"The submission cannot be read: its reader ended ({report.exit_reason.value})."
        raise StudentError(Diagnosis(Kind.UNREADABLE, sentence)) from None


def main() -> None:
    """Read the submission on the command line with the reader named there, and print the outcome."""
    reader, path, assignment = sys.argv[1:]
    answer: dict[str, Any]
    try:
        answer = {"read": _read(reader, Path(path), assignment, Isolation.PROCESS)}
    except StudentError as error:
        answer = {"refused": asdict(error.diagnosis)}
    sys.stdout.buffer.write(json.dumps(answer, ensure_ascii=False).encode("utf-8", "backslashreplace"))


if __name__ == "__main__":
    main()
