"""Arranges a result for a feedback page, without any markup."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from autograder.diagnosis import Kind
from autograder.plain_text import clean
from autograder.report.feedback.pictures import Picture, read_picture
from autograder.result.causes import Cause, causes, dearest
from autograder.result.model import CheckResult, Result, Status
from autograder.suite import Outcome
from autograder.suite.contract import Sentence


@dataclass(frozen=True)
class CheckView:
    """A check on a page, with those that did not pass because it did not.

    Attributes:
        result: its result.
        contract: the sentences that a program broke, by which it failed the check; of a check that failed with another
            one, those that are not quoted above it.
        pictures: its pictures.
        also: the checks that failed as well.
        not_checked: the line about what could not be checked, or an empty string.
        unnamed: the titles of what that line only counts.
    """

    result: CheckResult
    contract: tuple[str, ...]
    pictures: tuple[Picture, ...]
    also: tuple[CheckView, ...] = ()
    not_checked: str = ""
    unnamed: tuple[str, ...] = ()

    @property
    def message(self) -> str:
        """The reason of the outcome, or an empty string."""
        return clean(self.result.message).strip()


@dataclass(frozen=True)
class Elsewhere:
    """The checks of a group that did not pass because of a check of another group."""

    cause: CheckResult
    results: tuple[CheckResult, ...]

    @property
    def count(self) -> str:
        """How many they are, in words."""
        return f"{len(self.results)} check{'s' if len(self.results) > 1 else ''}"

    @property
    def lost(self) -> float:
        """The points that they lost."""
        return sum(result.max_points - result.points for result in self.results)


@dataclass(frozen=True)
class GroupView:
    """The checks that count for one locked grade cell.

    Attributes:
        name: the group's.
        results: all of its checks.
        checks: the checks to show, with those of any group that came with them.
        elsewhere: its checks that are shown in other groups.
    """

    name: str
    results: tuple[CheckResult, ...]
    checks: tuple[CheckView, ...]
    elsewhere: tuple[Elsewhere, ...] = ()

    @property
    def points(self) -> float:
        """The points that the checks earned."""
        return sum(result.points for result in self.results)

    @property
    def max_points(self) -> float:
        """The points that the checks are worth."""
        return sum(result.max_points for result in self.results)

    @property
    def pictures(self) -> tuple[Picture, ...]:
        """The pictures of all checks that are shown."""
        return tuple(picture for check in self.checks for one in (check, *check.also) for picture in one.pictures)


@dataclass(frozen=True)
class PageView:
    """The content of a feedback page.

    Attributes:
        result: the result that it shows.
        groups: the groups of checks, in the order of the suite.
        pictures: pictures that belong to no check.
        first: the check with which to start, or None: of those that failed, the one that costs most points, together
            with those that failed or were not checked because of it.
    """

    result: Result
    groups: tuple[GroupView, ...]
    pictures: tuple[Picture, ...]
    first: CheckResult | None

    @property
    def graded(self) -> bool:
        """Whether there is a score. There is none if the grader failed."""
        return self.result.status is Status.GRADED

    @property
    def started(self) -> bool:
        """Whether the submission was built and started, so that there is no diagnosis to show."""
        return self.result.diagnosis.kind is Kind.OK

    @property
    def plays(self) -> bool:
        """Whether the page has a run to play."""
        shown = [*self.pictures, *(picture for group in self.groups for picture in group.pictures)]
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
        picture = None if folder is None else read_picture(artifact, folder)
        if picture is not None:
            pictures.setdefault(artifact.check if artifact.check in known else "", []).append(picture)
    found = causes(result.checks, result.diagnosis.sentence)

    def view(check: CheckResult, cause: Cause | None = None, quoted: tuple[str, ...] = ()) -> CheckView:
        judged = check.outcome is Outcome.FAILED and check.message != result.diagnosis.sentence
        held = check.holds if judged else ()  # a program that does not run has broken none of them in particular
        sentences = dict.fromkeys(contract[name].text for name in held if name in contract)
        told = tuple(sentence for sentence in sentences if sentence not in quoted)
        shown = CheckView(check, told, tuple(pictures.get(check.id, ())))
        if cause is None:
            return shown
        also: list[CheckView] = []
        for one in cause.failed:
            also.append(view(one, quoted=(*told, *(sentence for seen in also for sentence in seen.contract))))
        return replace(shown, also=tuple(also), not_checked=cause.not_checked, unnamed=cause.unnamed)

    groups = []
    for name in dict.fromkeys(check.group for check in result.checks):
        shown = tuple(view(cause.check, cause) for cause in found if cause.check.group == name)
        others = ((cause, tuple(one for one in cause.checks if one.group == name)) for cause in found)
        elsewhere = tuple(Elsewhere(cause.check, came) for cause, came in others if came and cause.check.group != name)
        groups.append(GroupView(name, result.group(name), shown, elsewhere))
    return PageView(result, tuple(groups), tuple(pictures.get("", ())), dearest(found))
