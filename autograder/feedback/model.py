"""Arranges a result for a feedback page, without any markup."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from autograder.checks import Outcome
from autograder.checks.contract import Sentence
from autograder.diagnosis import Kind
from autograder.feedback.pictures import Picture, read_picture
from autograder.plain_text import clean
from autograder.result import CheckResult, Result, Status


@dataclass(frozen=True)
class CheckView:
    """A check on a page.

    `message` is empty if the check before it says the same. `contract` holds the sentences that a check which failed
    holds a student to.
    """

    result: CheckResult
    message: str
    contract: tuple[str, ...]
    pictures: tuple[Picture, ...]


@dataclass(frozen=True)
class GroupView:
    """The checks that count for one locked grade cell."""

    name: str
    checks: tuple[CheckView, ...]

    @property
    def points(self) -> float:
        """The points that the checks earned."""
        return sum(check.result.points for check in self.checks)

    @property
    def max_points(self) -> float:
        """The points that the checks are worth."""
        return sum(check.result.max_points for check in self.checks)


@dataclass(frozen=True)
class PageView:
    """The content of a feedback page: the groups in the order of the suite, and pictures that belong to no check."""

    result: Result
    groups: tuple[GroupView, ...]
    pictures: tuple[Picture, ...]

    @property
    def graded(self) -> bool:
        """Whether there is a score. There is none if the grader failed."""
        return self.result.status is Status.GRADED

    @property
    def started(self) -> bool:
        """Whether the submission was built and started, so that there is no diagnosis to show."""
        return self.result.diagnosis.kind is Kind.OK

    @property
    def first(self) -> CheckResult | None:
        """The first check that failed, or None."""
        checks = (check.result for group in self.groups for check in group.checks)
        return next((check for check in checks if check.outcome is Outcome.FAILED), None)

    @property
    def plays(self) -> bool:
        """Whether the page has a run to play."""
        shown = [*self.pictures, *(p for group in self.groups for check in group.checks for p in check.pictures)]
        return self.graded and any(picture.run is not None for picture in shown)

    @property
    def percent(self) -> int:
        """The score in per cent, rounded down."""
        return int(self.result.percent + 1e-9)


def page_view(result: Result, folder: Path | None, contract: Mapping[str, Sentence] = {}) -> PageView:
    """Return the content of the page of a result.

    Args:
        result: the result to show.
        folder: the folder with its artifacts, or None for a page without pictures.
        contract: the sentences of the assignment's contract, by their ids.
    """
    known = {check.id for check in result.checks}
    pictures: dict[str, list[Picture]] = {}
    for artifact in result.artifacts:
        found = None if folder is None else read_picture(artifact, folder)
        if found is not None:
            pictures.setdefault(artifact.check if artifact.check in known else "", []).append(found)
    groups = tuple(
        GroupView(name, _checks(result.group(name), pictures, contract))
        for name in dict.fromkeys(check.group for check in result.checks)
    )
    return PageView(result, groups, tuple(pictures.get("", ())))


def _checks(
    checks: Sequence[CheckResult], pictures: Mapping[str, Sequence[Picture]], contract: Mapping[str, Sentence]
) -> tuple[CheckView, ...]:
    views: list[CheckView] = []
    last_reason = ""  # the reason for which the check before was not checked
    for check in checks:
        held = check.holds if check.outcome is Outcome.FAILED else ()
        sentences = tuple(contract[name].text for name in held if name in contract)
        message = clean(check.message).strip()
        skipped = check.outcome is Outcome.NOT_CHECKED
        shown = "" if skipped and message == last_reason else message
        views.append(CheckView(check, shown, sentences, tuple(pictures.get(check.id, ()))))
        last_reason = message if skipped else ""
    return tuple(views)
