"""A result as its reader sees it: what is shown, in which order and under which heading. Pure; no markup here."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from urllib.parse import urlsplit

from autograder.checks import Outcome, Visibility
from autograder.diagnosis import Kind
from autograder.feedback.text import clean
from autograder.result import Artifact, CheckResult, Result, Status


@dataclass(frozen=True)
class Picture:
    """A picture to show: its data URI, or None where the file is gone, and what it shows in words."""

    uri: str | None
    caption: str


@dataclass(frozen=True)
class CheckView:
    """One check as shown. `outcome` is a word; `doc` is a link that is safe to follow, or None."""

    id: str
    title: str
    outcome: str
    points: float
    max_points: float
    message: str
    hints: tuple[str, ...]
    doc: str | None
    pictures: tuple[Picture, ...]


@dataclass(frozen=True)
class GroupView:
    """The checks that count for one locked grade cell; `withheld` of them stay closed until the due date."""

    name: str
    points: float
    max_points: float
    checks: tuple[CheckView, ...]
    withheld: int


@dataclass(frozen=True)
class PageView:
    """All that a feedback page says.

    Attributes:
        graded: False when the grader itself failed; then there is no score to show.
        good: the submission came to life; nothing to diagnose.
        first: the check to begin with, the first one that failed, or None.
        pictures: those that belong to no check.
    """

    result: Result
    graded: bool
    good: bool
    groups: tuple[GroupView, ...]
    first: CheckView | None
    pictures: tuple[Picture, ...]

    @property
    def percent(self) -> int:
        """The score in whole per cent, never rounded up to 100."""
        return int(self.result.percent + 1e-9)


def view(result: Result, picture: Callable[[Artifact], Picture | None], *, after_due: bool = False) -> PageView:
    """Lay out a result.

    Args:
        result: what to show.
        picture: turns an artifact into a picture, None for one that is no picture.
        after_due: also show the checks that stay closed until the due date.
    """
    shown = {check.id for check in result.checks if after_due or check.visibility is not Visibility.AFTER_DUE}
    known = {check.id for check in result.checks}
    pictures: dict[str, list[Picture]] = {}
    for artifact in result.artifacts:
        if artifact.check in known - shown:
            continue
        found = picture(artifact)
        if found is not None:
            pictures.setdefault(artifact.check if artifact.check in shown else "", []).append(found)
    groups = tuple(
        _group(name, result.group(name), shown, pictures) for name in dict.fromkeys(c.group for c in result.checks)
    )
    checks = [check for group in groups for check in group.checks]
    return PageView(
        result=result,
        graded=result.status is Status.GRADED,
        good=result.diagnosis.kind is Kind.OK,
        groups=groups,
        first=next((check for check in checks if check.outcome == Outcome.FAILED.words), None),
        pictures=tuple(pictures.get("", ())),
    )


def _group(name: str, checks: Iterable[CheckResult], shown: set[str], pictures: dict[str, list[Picture]]) -> GroupView:
    checks = tuple(checks)
    views = [_check(check, tuple(pictures.get(check.id, ()))) for check in checks if check.id in shown]
    views = [
        replace(after, message="") if _repeats(before, after) else after
        for before, after in zip([None, *views], views, strict=False)
    ]
    return GroupView(
        name=name,
        points=sum(check.points for check in checks),
        max_points=sum(check.max_points for check in checks),
        checks=tuple(views),
        withheld=len(checks) - len(views),
    )


def _repeats(before: CheckView | None, after: CheckView) -> bool:
    """Return whether a check was left out for the reason that stands just above it."""
    idle = after.outcome == Outcome.NOT_CHECKED.words
    return before is not None and idle and (before.outcome, before.message) == (after.outcome, after.message)


def _check(check: CheckResult, pictures: tuple[Picture, ...]) -> CheckView:
    return CheckView(
        id=check.id,
        title=check.title,
        outcome=check.outcome.words,
        points=check.points,
        max_points=check.max_points,
        message=clean(check.message).strip(),
        hints=() if check.outcome is Outcome.PASSED else check.hints,
        doc=safe_link(check.doc),
        pictures=pictures,
    )


def safe_link(address: str | None) -> str | None:
    """Return `address` when it is a web address, else None."""
    if address is None or urlsplit(address).scheme not in ("http", "https"):
        return None
    return address
