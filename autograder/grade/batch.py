"""Grading a class: many submissions at once, each in a cell of its own, results written one by one."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path

from autograder.exceptions import AutograderError, UsageError
from autograder.grade.apart import Digests, read_digests
from autograder.grade.parallel import map_parallel
from autograder.grade.pipeline import grade_submission
from autograder.grade.store import LOG, NOTEBOOK, RESULT, new_result, remove_unfinished
from autograder.result.model import Result, Status, from_json, write_json
from autograder.run.sandbox import Tier
from autograder.submission.intake.exercises import exercises_of
from autograder.submission.intake.ignored import is_ignored
from autograder.submission.intake.names import is_archive, is_notebook, stem
from autograder.suite import suites

TIMESTAMP = "timestamp.txt"  # of nbgrader, beside what was handed in
NO_SUBMISSION = "it is not a folder, an archive or a notebook"

OnResult = Callable[[Result], None]


@dataclass(frozen=True)
class Entry:
    """One submission of a class: whose it is, and where it lies."""

    student: str
    path: Path


@dataclass(frozen=True)
class Discovered:
    """The submissions in some folders, and what else lies there, as pairs of a name and the reason."""

    entries: tuple[Entry, ...]
    others: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class GradingRequest:
    """One submission of a class to grade into the folder `out`; `resume` says whether a stored result counts."""

    student: str
    path: Path
    assignment: str
    seed: int
    isolation: Tier
    out: Path
    resume: bool = False

    @cached_property
    def digests(self) -> Digests | None:
        """The digests of what was handed in, None if it cannot be read."""
        return read_digests(self.path, self.assignment, self.isolation)

    def stored(self) -> Result | None:
        """Return the stored result if it may be kept: its submission, suite, seed and isolation are the same."""
        if not self.resume:
            return None
        try:
            result = from_json(json.loads((self.out / RESULT).read_text()), source=str(self.out / RESULT))
        except (OSError, ValueError, AutograderError):
            return None
        digest = self.digests and self.digests.sha256
        suite = suites.hidden(self.assignment)
        found = (result.student, result.submission_sha256, result.suite_version, result.seed, result.isolation)
        same = found == (self.student, digest, suite.version, self.seed, self.isolation.value)
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

    def store_copy(self, result: Result, folder: Path) -> Result:
        """Store the result of an equal submission, whose files lie in `folder`, as that of this one."""
        shown = {name for artifact in result.artifacts for name in (artifact.name, artifact.run)}
        own = replace(result, student=self.student)
        if (found := self.digests) is not None:  # what counts is equal; what lies around it may differ
            digest = found.sha256 if result.status is Status.GRADED else result.submission_sha256
            notices = result.notices if found.notices is None else found.notices
            own = replace(own, submission_sha256=digest, notices=notices, unused=found.unused)
        with new_result(self.out) as new:
            for path in (folder / name for name in (NOTEBOOK, LOG, *shown - {""})):
                if path.is_file():
                    shutil.copy(path, new)
            write_json(new / RESULT, own.to_json())
        return own


GradeEach = Callable[[Sequence[GradingRequest], OnResult], None]
"""Grades what is asked for, and hands over each result as it comes."""


def grade_here(requests: Sequence[GradingRequest], on_result: OnResult, *, jobs: int) -> None:
    """Grade on this machine, `jobs` submissions at once."""
    map_parallel(GradingRequest.grade, requests, jobs=jobs, on_done=on_result)


def discover(paths: tuple[Path, ...], assignment: str) -> Discovered:
    """Find the submissions at `paths`: each is one, or a folder of them.

    A folder of submissions has one file or folder for each student, or nbgrader's `submitted/STUDENT/ASSIGNMENT`.

    Raises:
        UsageError: a path does not exist, a folder holds nothing, or two submissions have the same student's name.
    """
    found: list[Entry] = []
    others: list[tuple[str, str]] = []
    for path in paths:
        if not path.exists():
            raise UsageError(f"{path}: there is no such file or folder")
        if path.is_file():
            found.append(Entry(student_of(path), path))
        elif _is_submission(path, assignment):
            found.append(Entry(path.resolve().name, path))
        else:
            entries, beside = _of_folder(path, assignment)
            found += entries
            others += beside
    names = [entry.student for entry in found]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise UsageError(
            f"two submissions are called {', '.join(twice)}: rename one, results would overwrite each other"
        )
    return Discovered(tuple(found), tuple(others))


def student_of(path: Path) -> str:
    """Return the name that a submitted file or folder gives its student: `ada` for `ada.tar.gz`."""
    if path.is_dir():
        return path.name
    return stem(path.name) if stem(path.name) != path.name else path.stem


def submission_in(folder: Path, assignment: str) -> Path:
    """Return what a student's folder means: in nbgrader's layout, the folder of the assignment in it."""
    inner = folder / assignment
    if not inner.is_dir():
        return folder
    beside = (child for child in folder.iterdir() if not is_ignored(child.name))
    return inner if all(child.is_dir() or child.name == TIMESTAMP for child in beside) else folder


def grade_all(
    entries: tuple[Entry, ...],
    assignment: str,
    *,
    seed: int,
    out: Path,
    jobs: int,
    isolation: Tier = Tier.BUBBLEWRAP,
    resume: bool = False,
    on_result: OnResult = lambda result: None,
    grade_each: GradeEach | None = None,
) -> tuple[Result, ...]:
    """Grade submissions, `jobs` at once; `out`/STUDENT gets each one's result and pictures.

    Of equal submissions one is graded, and the others take over its result.

    Args:
        entries: from `discover`.
        assignment: which assignment they answer.
        seed: every hidden input is drawn from it, the same for all.
        out: the folder of the results.
        jobs: how many are graded at once; the results do not depend on it.
        isolation: the sandbox's tier.
        resume: keep a stored result whose submission, suite, seed and isolation are the same.
        on_result: called for each result as it comes, in any order.
        grade_each: grades the requests in place of `jobs` workers of this machine.

    Returns:
        The results, in the order of `entries`. Ctrl-C lets end what has begun, and leaves the rest to `resume`.
    """
    requests = [
        GradingRequest(entry.student, entry.path, assignment, seed, isolation, out / entry.student, resume)
        for entry in entries
    ]
    equal: dict[str, list[GradingRequest]] = {}
    for request in requests:
        remove_unfinished(request.out)
        found = request.digests
        equal.setdefault(found.graded_sha256 if found else f"of {request.student}", []).append(request)
    first = {group[0].student: group for group in equal.values()}
    results: dict[str, Result] = {}

    def store(result: Result) -> None:
        graded, *others = first[result.student]
        for other in (result, *(request.stored() or request.store_copy(result, graded.out) for request in others)):
            results[other.student] = other
            on_result(other)

    left = []
    for request, *_ in first.values():
        if (kept := request.stored()) is not None:
            store(kept)
        else:
            left.append(request)
    (grade_each or partial(grade_here, jobs=jobs))(left, store)
    return tuple(results[entry.student] for entry in entries)


def _is_submission(folder: Path, assignment: str) -> bool:
    if any((folder / name).exists() for name in (f"{assignment}.ipynb", "ws", "src")):
        return True
    exercises = exercises_of(assignment)
    own = {path.parts[0] for path in exercises.beside if len(path.parts) > 1} if exercises is not None else ()
    return any((folder / name).is_dir() for name in own)  # figures, which each release of the chapter has


def _of_folder(folder: Path, assignment: str) -> tuple[list[Entry], list[tuple[str, str]]]:
    children = sorted(child for child in folder.iterdir() if not (child.name.startswith(".") or is_ignored(child.name)))
    students = [child for child in children if child.is_dir() or is_archive(child.name) or is_notebook(child.name)]
    if not students:
        raise UsageError(f"{folder}: neither a submission of {assignment} nor a folder of submissions")
    entries = [
        Entry(student_of(child), submission_in(child, assignment) if child.is_dir() else child) for child in students
    ]
    return entries, [(child.name, NO_SUBMISSION) for child in children if child not in students]
