"""Compares two gradings of a class, and lists the students and checks whose points differ."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from autograder.exceptions import UsageError
from autograder.result.model import Result, Status


@dataclass(frozen=True)
class CheckChange:
    """A check whose points differ. None means that the check is missing from that suite."""

    id: str
    before: float | None
    after: float | None


@dataclass(frozen=True)
class Change:
    """A student whose result differs between two gradings.

    Attributes:
        before: points in the old grading, or None if it gave no mark.
        after: points in the new grading, or None if it gave no mark.
        same_submission: whether both gradings used the same files.
        checks: the checks whose points differ, in the order of the suite.
    """

    assignment: str
    student: str
    before: float | None
    after: float | None
    same_submission: bool
    checks: tuple[CheckChange, ...]


def changes(old: Sequence[Result], new: Sequence[Result]) -> tuple[Change, ...]:
    """Return the students whose marks or points of a check differ. Students of the old grading come first.

    Raises:
        UsageError: one of the gradings has two results for a student in an assignment.
    """
    before, after = _by_student(old, "old"), _by_student(new, "new")
    changed = []
    for key in dict.fromkeys((*before, *after)):
        old_result, new_result = before.get(key), after.get(key)
        checks = tuple(_checks(old_result, new_result))
        if checks or _mark(old_result) != _mark(new_result):
            is_same = (
                old_result is not None
                and new_result is not None
                and old_result.submission_sha256 == new_result.submission_sha256
            )
            changed.append(Change(*key, _mark(old_result), _mark(new_result), is_same, checks))
    return tuple(changed)


def _by_student(results: Sequence[Result], label: str) -> dict[tuple[str, str], Result]:
    by_student: dict[tuple[str, str], Result] = {}
    for result in results:
        key = (result.assignment, result.student)
        if key in by_student:
            raise UsageError(
                f"the {label} results contain {key[1]!r} twice for {key[0]}; use the folder of one grading"
            )
        by_student[key] = result
    return by_student


def _mark(result: Result | None) -> float | None:
    return None if result is None or result.status is not Status.GRADED else result.score


def _checks(old_result: Result | None, new_result: Result | None) -> Iterator[CheckChange]:
    if old_result is None or new_result is None:
        return
    before = {check.id: check.points for check in old_result.checks}
    after = {check.id: check.points for check in new_result.checks}
    for name in dict.fromkeys((*before, *after)):
        if before.get(name) != after.get(name):
            yield CheckChange(name, before.get(name), after.get(name))
