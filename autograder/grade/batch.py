"""Grades a class: several submissions at once, each in its own worker sandbox. Results are written one by one."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from autograder.exceptions import AutograderError, UsageError
from autograder.grade.job import Job
from autograder.grade.parallel import map_parallel
from autograder.grade.pipeline import grade_submission
from autograder.grade.store import LOG, NOTEBOOK, RESULT, remove_unfinished, write_result
from autograder.result.class_folder import folder_name_problem
from autograder.result.model import Result, Status, from_json
from autograder.run.sandbox import Isolation
from autograder.submission.intake.exercises import exercises_of
from autograder.submission.intake.ignored import is_ignored
from autograder.submission.intake.names import is_archive, is_notebook, stem

TIMESTAMP = "timestamp.txt"  # nbgrader writes this file beside a submission
NO_SUBMISSION = "it is not a folder, an archive or a notebook"

OnResult = Callable[[Result], None]


@dataclass(frozen=True)
class Discovered:
    """Submissions by student, and the other files beside them, each with the reason why it is not a submission."""

    submissions: Mapping[str, Path]
    other_files: tuple[tuple[str, str], ...]


GradeJobs = Callable[[Sequence[Job], OnResult], None]
"""Grades submissions, and calls a function with each result as soon as it is available."""


def grade_locally(submissions: Sequence[Job], on_result: OnResult, *, jobs: int) -> None:
    """Grade on this machine, `jobs` submissions at once."""
    map_parallel(grade_submission, submissions, jobs=jobs, on_done=on_result)


def discover(paths: tuple[Path, ...], assignment: str) -> Discovered:
    """Find the submissions at `paths`. Each path is a submission or a folder of submissions.

    A folder of submissions contains one file or folder for each student, or is nbgrader's `submitted` folder, which
    contains `STUDENT/ASSIGNMENT`.

    Raises:
        UsageError: a path does not exist, a folder contains no submission, or two submissions have the same name.
    """
    submissions: list[tuple[str, Path]] = []
    other_files: list[tuple[str, str]] = []
    for path in paths:
        if not path.exists():
            raise UsageError(f"{path}: there is no such file or folder")
        if path.is_file():
            submissions.append((student_of(path), path))
        elif _is_submission(path, assignment):
            submissions.append((path.resolve().name, path))
        else:
            folder_submissions, folder_other_files = _discover_in_folder(path, assignment)
            submissions += folder_submissions
            other_files += folder_other_files
    problems = {student: problem for student, _ in submissions if (problem := folder_name_problem(student))}
    other_files += [(path.name, problems[student]) for student, path in submissions if student in problems]
    submissions = [(student, path) for student, path in submissions if student not in problems]
    names = [student for student, _ in submissions]
    duplicates = sorted({name for name in names if names.count(name) > 1})
    if duplicates:
        raise UsageError(
            f"two submissions are called {', '.join(duplicates)}: rename one, because their results would "
            "overwrite each other"
        )
    return Discovered(dict(submissions), tuple(other_files))


def student_of(path: Path) -> str:
    """Return the student's name, after which a submitted file or folder is named: `ada` for `ada.tar.gz`."""
    if path.is_dir():
        return path.name
    return stem(path.name) if stem(path.name) != path.name else path.stem


def submission_in(folder: Path, assignment: str) -> Path:
    """Return the submission in a student's folder: in nbgrader's layout, the folder of the assignment."""
    inner = folder / assignment
    if not inner.is_dir():
        return folder
    children = (child for child in folder.iterdir() if not is_ignored(child.name))
    return inner if all(child.is_dir() or child.name == TIMESTAMP for child in children) else folder


def grade_all(
    submissions: Mapping[str, Path],
    assignment: str,
    *,
    seed: int,
    out: Path,
    jobs: int,
    isolation: Isolation = Isolation.BUBBLEWRAP,
    resume: bool = False,
    on_result: OnResult = lambda result: None,
    grade_jobs: GradeJobs | None = None,
) -> tuple[Result, ...]:
    """Grade submissions, `jobs` at once, and write the result and pictures of each to `out`/STUDENT.

    Of equal submissions, only one is graded, and its result is copied for the others.

    Args:
        submissions: the submissions by student, from `discover`.
        assignment: the assignment of all submissions.
        seed: the number from which every hidden input is drawn, the same for all submissions.
        out: the folder of the results.
        jobs: how many submissions are graded at once. The results do not depend on it.
        isolation: the isolation level.
        resume: whether to reuse a stored result with the same submission, suite, seed and isolation level.
        on_result: is called with each result as soon as it is available, in any order.
        grade_jobs: grades the submissions, by default with `jobs` workers on this machine.

    Returns:
        The results, in the order of `submissions`. After Ctrl-C, running gradings finish, and `resume` continues later.
    """
    equal: dict[str, list[Job]] = {}
    for student, path in submissions.items():
        job = Job(path, assignment, student, seed, out / student, isolation)
        remove_unfinished(job.out)
        digests = job.digests if len(submissions) > 1 else None  # a single submission is compared with no other
        equal.setdefault(digests.graded_sha256 if digests else f"of {student}", []).append(job)
    groups = {group[0].student: group for group in equal.values()}
    results: dict[str, Result] = {}

    def reusable_result(job: Job) -> Result | None:
        return stored_result(job) if resume else None

    def add_result(result: Result) -> None:
        graded_job, *equal_jobs = groups[result.student]
        copies = (reusable_result(job) or _copy(result, graded_job, job) for job in equal_jobs)
        for student_result in (result, *copies):
            results[student_result.student] = student_result
            on_result(student_result)

    remaining = []
    for job, *_ in groups.values():
        if (result := reusable_result(job)) is not None:
            add_result(result)
        else:
            remaining.append(job)
    (grade_jobs or partial(grade_locally, jobs=jobs))(remaining, add_result)
    return tuple(results[student] for student in submissions)


def stored_result(job: Job) -> Result | None:
    """Return a job's stored result if it can be reused: its submission, suite, seed and isolation are the same."""
    try:
        result = from_json(json.loads((job.out / RESULT).read_text()), source=str(job.out / RESULT))
    except (OSError, ValueError, AutograderError):
        return None
    digest = job.digests and job.digests.sha256
    actual = (result.student, result.submission_sha256, result.suite_version, result.seed, result.isolation)
    is_same = actual == (job.student, digest, job.suite.version, job.seed, job.isolation.value)
    return result if is_same and result.status is Status.GRADED else None


def _copy(result: Result, graded_job: Job, job: Job) -> Result:
    """Store the result of `graded_job` as the result of `job`, whose submission is equal."""
    if (digests := job.digests) is not None:  # the files that are graded are the same, but others may differ
        digest = digests.sha256 if result.status is Status.GRADED else result.submission_sha256
        notices = result.notices if digests.notices is None else digests.notices
        result = replace(result, submission_sha256=digest, notices=notices, unused=digests.unused)
    artifacts = {name for artifact in result.artifacts for name in (artifact.name, artifact.run) if name}
    files = ((name, graded_job.out / name) for name in (NOTEBOOK, LOG, *artifacts))
    return write_result(job, result, {name: path.read_bytes() for name, path in files if path.is_file()})


def _is_submission(folder: Path, assignment: str) -> bool:
    if any((folder / name).exists() for name in (f"{assignment}.ipynb", "ws", "src")):
        return True
    exercises = exercises_of(assignment)
    names = {path.parts[0] for path in exercises.other_files if len(path.parts) > 1} if exercises is not None else ()
    return any((folder / name).is_dir() for name in names)  # such as `figures`, which every release contains


def _discover_in_folder(folder: Path, assignment: str) -> tuple[list[tuple[str, Path]], list[tuple[str, str]]]:
    children = sorted(child for child in folder.iterdir() if not (child.name.startswith(".") or is_ignored(child.name)))
    students = [child for child in children if child.is_dir() or is_archive(child.name) or is_notebook(child.name)]
    if not students:
        raise UsageError(f"{folder}: neither a submission of {assignment} nor a folder of submissions")
    submissions = [
        (student_of(child), submission_in(child, assignment) if child.is_dir() else child) for child in students
    ]
    return submissions, [(child.name, NO_SUBMISSION) for child in children if child not in students]
