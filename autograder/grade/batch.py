"""Grading a class: many submissions at once, each in its own worker sandbox, results written one by one."""

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

TIMESTAMP = "timestamp.txt"  # a file of nbgrader beside the submission
NO_SUBMISSION = "it is not a folder, an archive or a notebook"

OnResult = Callable[[Result], None]


@dataclass(frozen=True)
class Discovered:
    """Submissions by student, and the other files beside them, as pairs of a name and the reason."""

    submissions: Mapping[str, Path]
    others: tuple[tuple[str, str], ...]


GradeEach = Callable[[Sequence[Job], OnResult], None]
"""Grades submissions, and hands over each result as it comes."""


def grade_here(todo: Sequence[Job], on_result: OnResult, *, jobs: int) -> None:
    """Grade on this machine, `jobs` submissions at once."""
    map_parallel(grade_submission, todo, jobs=jobs, on_done=on_result)


def discover(paths: tuple[Path, ...], assignment: str) -> Discovered:
    """Find the submissions at `paths`: each is one, or a folder of them.

    A folder of submissions has one file or folder for each student, or nbgrader's `submitted/STUDENT/ASSIGNMENT`.

    Raises:
        UsageError: a path does not exist, a folder holds nothing, or two submissions have the same student's name.
    """
    submissions: list[tuple[str, Path]] = []
    others: list[tuple[str, str]] = []
    for path in paths:
        if not path.exists():
            raise UsageError(f"{path}: there is no such file or folder")
        if path.is_file():
            submissions.append((student_of(path), path))
        elif _is_submission(path, assignment):
            submissions.append((path.resolve().name, path))
        else:
            inside, beside = _of_folder(path, assignment)
            submissions += inside
            others += beside
    refused = {student: why for student, _ in submissions if (why := folder_name_problem(student))}
    others += [(path.name, refused[student]) for student, path in submissions if student in refused]
    submissions = [(student, path) for student, path in submissions if student not in refused]
    names = [student for student, _ in submissions]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise UsageError(
            f"two submissions are called {', '.join(twice)}: rename one, results would overwrite each other"
        )
    return Discovered(dict(submissions), tuple(others))


def student_of(path: Path) -> str:
    """Return the name that a submitted file or folder gives its student: `ada` for `ada.tar.gz`."""
    if path.is_dir():
        return path.name
    return stem(path.name) if stem(path.name) != path.name else path.stem


def submission_in(folder: Path, assignment: str) -> Path:
    """Return the submission in a student's folder: in nbgrader's layout, the folder of the assignment."""
    inner = folder / assignment
    if not inner.is_dir():
        return folder
    beside = (child for child in folder.iterdir() if not is_ignored(child.name))
    return inner if all(child.is_dir() or child.name == TIMESTAMP for child in beside) else folder


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
    grade_each: GradeEach | None = None,
) -> tuple[Result, ...]:
    """Grade submissions, `jobs` at once; `out`/STUDENT gets each one's result and pictures.

    Of equal submissions one is graded, and the others take over its result.

    Args:
        submissions: by their students, from `discover`.
        assignment: which assignment they answer.
        seed: every hidden input is drawn from it, the same for all.
        out: the folder of the results.
        jobs: how many are graded at once; the results do not depend on it.
        isolation: The isolation level.
        resume: keep a stored result whose submission, suite, seed and isolation are the same.
        on_result: called for each result as it comes, in any order.
        grade_each: grades them in place of `jobs` workers of this machine.

    Returns:
        The results, in the order of `submissions`. After Ctrl-C, running gradings finish, and `resume` continues later.
    """
    equal: dict[str, list[Job]] = {}
    for student, path in submissions.items():
        job = Job(path, assignment, student, seed, out / student, isolation)
        remove_unfinished(job.out)
        digests = job.digests if len(submissions) > 1 else None  # one alone is read by its worker, and nowhere else
        equal.setdefault(digests.graded_sha256 if digests else f"of {student}", []).append(job)
    groups = {group[0].student: group for group in equal.values()}
    results: dict[str, Result] = {}

    def kept(job: Job) -> Result | None:
        return stored(job) if resume else None

    def take(result: Result) -> None:
        graded, *others = groups[result.student]
        for each in (result, *(kept(job) or _copy(result, graded, job) for job in others)):
            results[each.student] = each
            on_result(each)

    left = []
    for job, *_ in groups.values():
        if (result := kept(job)) is not None:
            take(result)
        else:
            left.append(job)
    (grade_each or partial(grade_here, jobs=jobs))(left, take)
    return tuple(results[student] for student in submissions)


def stored(job: Job) -> Result | None:
    """Return a job's stored result if it may be kept: its submission, suite, seed and isolation are the same."""
    try:
        result = from_json(json.loads((job.out / RESULT).read_text()), source=str(job.out / RESULT))
    except (OSError, ValueError, AutograderError):
        return None
    digest = job.digests and job.digests.sha256
    actual = (result.student, result.submission_sha256, result.suite_version, result.seed, result.isolation)
    same = actual == (job.student, digest, job.suite.version, job.seed, job.isolation.value)
    return result if same and result.status is Status.GRADED else None


def _copy(result: Result, graded: Job, job: Job) -> Result:
    """Store the result of a graded submission as that of an equal one."""
    if (digests := job.digests) is not None:  # the same answer; the files around it may differ
        digest = digests.sha256 if result.status is Status.GRADED else result.submission_sha256
        notices = result.notices if digests.notices is None else digests.notices
        result = replace(result, submission_sha256=digest, notices=notices, unused=digests.unused)
    shown = {name for artifact in result.artifacts for name in (artifact.name, artifact.run) if name}
    files = ((name, graded.out / name) for name in (NOTEBOOK, LOG, *shown))
    return write_result(job, result, {name: path.read_bytes() for name, path in files if path.is_file()})


def _is_submission(folder: Path, assignment: str) -> bool:
    if any((folder / name).exists() for name in (f"{assignment}.ipynb", "ws", "src")):
        return True
    exercises = exercises_of(assignment)
    own = {path.parts[0] for path in exercises.other_files if len(path.parts) > 1} if exercises is not None else ()
    return any((folder / name).is_dir() for name in own)  # figures, which each release of the chapter has


def _of_folder(folder: Path, assignment: str) -> tuple[list[tuple[str, Path]], list[tuple[str, str]]]:
    children = sorted(child for child in folder.iterdir() if not (child.name.startswith(".") or is_ignored(child.name)))
    students = [child for child in children if child.is_dir() or is_archive(child.name) or is_notebook(child.name)]
    if not students:
        raise UsageError(f"{folder}: neither a submission of {assignment} nor a folder of submissions")
    submissions = [
        (student_of(child), submission_in(child, assignment) if child.is_dir() else child) for child in students
    ]
    return submissions, [(child.name, NO_SUBMISSION) for child in children if child not in students]
