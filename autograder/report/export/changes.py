"""Compares two gradings of a class: lists the students whose marks differ, and the checks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from autograder.exceptions import UsageError
from autograder.result.model import Result, Status


@dataclass(frozen=True)
class CheckChange:
    """A check with other points than before. A check that a suite has no more, or not yet, has None."""

    id: str
    before: float | None
    after: float | None


@dataclass(frozen=True)
class Change:
    """A student whose result differs between two gradings.

    Attributes:
        before: points of the old grading; None if there is no mark.
        after: points of the new grading, likewise.
        same_submission: whether both gradings saw the same files.
        checks: the checks with other points, in the order of the suite.
    """

    assignment: str
    student: str
    before: float | None
    after: float | None
    same_submission: bool
    checks: tuple[CheckChange, ...]


def changes(old: Sequence[Result], new: Sequence[Result]) -> tuple[Change, ...]:
    """Return the students whose marks, or points of a check, differ, in the order of the old grading and then the new.

    Raises:
        UsageError: one of the gradings has two results of a student in an assignment.
    """
    before, after = _by_student(old, "old"), _by_student(new, "new")
    found = []
    for key in dict.fromkeys((*before, *after)):
        first, second = before.get(key), after.get(key)
        checks = tuple(_checks(first, second))
        if checks or _mark(first) != _mark(second):
            same = first is not None and second is not None and first.submission_sha256 == second.submission_sha256
            found.append(Change(*key, _mark(first), _mark(second), same, checks))
    return tuple(found)


def _by_student(results: Sequence[Result], which: str) -> dict[tuple[str, str], Result]:
    found: dict[tuple[str, str], Result] = {}
    for result in results:
        key = (result.assignment, result.student)
        if key in found:
            raise UsageError(f"the {which} results hold {key[1]!r} twice for {key[0]}; give the folder of one grading")
        found[key] = result
    return found


def _mark(result: Result | None) -> float | None:
    return None if result is None or result.status is not Status.GRADED else result.score


def _checks(first: Result | None, second: Result | None) -> Iterator[CheckChange]:
    if first is None or second is None:
        return
    before = {check.id: check.points for check in first.checks}
    after = {check.id: check.points for check in second.checks}
    for name in dict.fromkeys((*before, *after)):
        if before.get(name) != after.get(name):
            yield CheckChange(name, before.get(name), after.get(name))
