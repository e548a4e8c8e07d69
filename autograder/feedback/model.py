"""Arranges a result for a feedback page, without any markup."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from urllib.parse import urlsplit

from autograder.checks import Outcome
from autograder.checks.contract import Sentence
from autograder.diagnosis import Kind
from autograder.feedback.text import clean
from autograder.result import Artifact, CheckResult, Result, Status


@dataclass(frozen=True)
class Picture:
    """A picture on a page: its data URI, or None if the file is missing, and its alternative text.

    `run` is the run that it shows as JSON for the player, or None; `name` is unique on the page.
    """

    uri: str | None
    caption: str
    name: str = ""
    run: str | None = None


@dataclass(frozen=True)
class CheckView:
    """A check on a page.

    `outcome` is in words. `doc` is an http or https address, or None. `contract` holds the sentences that a check which
    failed holds a student to.
    """

    id: str
    title: str
    outcome: str
    points: float
    max_points: float
    message: str
    hints: tuple[str, ...]
    doc: str | None
    contract: tuple[str, ...]
    pictures: tuple[Picture, ...]


@dataclass(frozen=True)
class GroupView:
    """The checks that count for one locked grade cell."""

    name: str
    points: float
    max_points: float
    checks: tuple[CheckView, ...]


@dataclass(frozen=True)
class PageView:
    """The content of a feedback page.

    Attributes:
        graded: whether there is a score. There is none if the grader failed.
        started: whether the submission was built and started, so that there is no diagnosis to show.
        groups: the groups of checks, in the order of the suite.
        first: the first check that failed, or None.
        pictures: pictures that belong to no check.
    """

    result: Result
    graded: bool
    started: bool
    groups: tuple[GroupView, ...]
    first: CheckView | None
    pictures: tuple[Picture, ...]

    @property
    def plays(self) -> bool:
        """Whether the page has a run to play."""
        shown = [*self.pictures, *(p for group in self.groups for check in group.checks for p in check.pictures)]
        return self.graded and any(picture.run is not None for picture in shown)

    @property
    def percent(self) -> int:
        """The score in per cent, rounded down."""
        return int(self.result.percent + 1e-9)


def page_view(
    result: Result, picture: Callable[[Artifact], Picture | None], contract: Mapping[str, Sentence] = {}
) -> PageView:
    """Return the content of the page of a result.

    Args:
        result: the result to show.
        picture: function that returns the picture of an artifact, or None if the artifact is not a picture.
        contract: the sentences of the assignment's contract, by their ids.
    """
    known = {check.id for check in result.checks}
    pictures: dict[str, list[Picture]] = {}
    for artifact in result.artifacts:
        found = picture(artifact)
        if found is not None:
            pictures.setdefault(artifact.check if artifact.check in known else "", []).append(found)
    groups = tuple(
        _group(name, result.group(name), pictures, contract) for name in dict.fromkeys(c.group for c in result.checks)
    )
    checks = [check for group in groups for check in group.checks]
    return PageView(
        result=result,
        graded=result.status is Status.GRADED,
        started=result.diagnosis.kind is Kind.OK,
        groups=groups,
        first=next((check for check in checks if check.outcome == Outcome.FAILED.words), None),
        pictures=tuple(pictures.get("", ())),
    )


def _group(
    name: str,
    checks: Sequence[CheckResult],
    pictures: dict[str, list[Picture]],
    contract: Mapping[str, Sentence],
) -> GroupView:
    views = [_check(check, tuple(pictures.get(check.id, ())), contract) for check in checks]
    views = [
        replace(after, message="") if _repeats(before, after) else after
        for before, after in zip([None, *views], views, strict=False)
    ]
    return GroupView(
        name=name,
        points=sum(check.points for check in checks),
        max_points=sum(check.max_points for check in checks),
        checks=tuple(views),
    )


def _repeats(before: CheckView | None, after: CheckView) -> bool:
    """Return whether a check was not checked for the same reason as the check before it."""
    skipped = after.outcome == Outcome.NOT_CHECKED.words
    return before is not None and skipped and (before.outcome, before.message) == (after.outcome, after.message)


def _check(check: CheckResult, pictures: tuple[Picture, ...], contract: Mapping[str, Sentence]) -> CheckView:
    held = check.holds if check.outcome is Outcome.FAILED else ()
    return CheckView(
        id=check.id,
        title=check.title,
        outcome=check.outcome.words,
        points=check.points,
        max_points=check.max_points,
        message=clean(check.message).strip(),
        hints=() if check.outcome is Outcome.PASSED else check.hints,
        doc=safe_link(check.doc),
        contract=tuple(contract[name].text for name in held if name in contract),
        pictures=pictures,
    )


def safe_link(address: str | None) -> str | None:
    """Return `address` if it is an http or https address, and None otherwise."""
    if address is None or urlsplit(address).scheme not in ("http", "https"):
        return None
    return address
