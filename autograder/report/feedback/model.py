"""Prepares the content of a feedback page, without markup."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from autograder.diagnosis import Kind
from autograder.plain_text import clean
from autograder.report.feedback.pictures import Picture, read_picture
from autograder.result.causes import Cause, causes, costliest_failure
from autograder.result.model import CheckResult, Result, Status
from autograder.suite import Outcome
from autograder.suite.contract import Requirement


@dataclass(frozen=True)
class CheckView:
    """A check on a page, with the checks that did not pass because of it.

    Attributes:
        result: its result.
        contract: the requirements that the program broke. For a check that failed because of another one,
            only those that are not already quoted with the other.
        pictures: its pictures.
        also_failed: the checks that failed because of it.
        not_checked: a line about checks that could not be run, or an empty string.
        unnamed: the titles of the checks that this line counts but does not name.
    """

    result: CheckResult
    contract: tuple[str, ...]
    pictures: tuple[Picture, ...]
    also_failed: tuple[CheckView, ...] = ()
    not_checked: str = ""
    unnamed: tuple[str, ...] = ()

    @property
    def message(self) -> str:
        """The reason for the outcome, or an empty string."""
        return clean(self.result.message).strip()


@dataclass(frozen=True)
class DependentChecks:
    """Checks of a group that did not pass because of a check in another group."""

    cause: CheckResult
    results: tuple[CheckResult, ...]

    @property
    def count(self) -> str:
        """The number of checks, in words."""
        return f"{len(self.results)} check{'s' if len(self.results) > 1 else ''}"

    @property
    def lost_points(self) -> float:
        """The points that these checks lost."""
        return sum(result.max_points - result.points for result in self.results)


@dataclass(frozen=True)
class GroupView:
    """The checks that count towards one locked grade cell.

    Attributes:
        name: the group's name.
        results: the results of all its checks.
        checks: the checks to show, including related ones from other groups.
        elsewhere: the checks of this group that are shown in other groups.
    """

    name: str
    results: tuple[CheckResult, ...]
    checks: tuple[CheckView, ...]
    elsewhere: tuple[DependentChecks, ...] = ()

    @property
    def points(self) -> float:
        return sum(result.points for result in self.results)

    @property
    def max_points(self) -> float:
        return sum(result.max_points for result in self.results)

    @property
    def pictures(self) -> tuple[Picture, ...]:
        """The pictures of all shown checks."""
        views = (view for check in self.checks for view in (check, *check.also_failed))
        return tuple(picture for view in views for picture in view.pictures)


@dataclass(frozen=True)
class PageView:
    """The content of a feedback page.

    Attributes:
        result: the result to show.
        groups: the groups of checks, in the order of the suite.
        pictures: pictures that do not belong to a check.
        costliest: the failed check that costs the most points, including checks that failed or were not run because of
            it; None if no check failed.
    """

    result: Result
    groups: tuple[GroupView, ...]
    pictures: tuple[Picture, ...]
    costliest: CheckResult | None

    @property
    def graded(self) -> bool:
        """Whether the result has a score. It has none if the grader failed."""
        return self.result.status is Status.GRADED

    @property
    def started(self) -> bool:
        """Whether the submission was built and started. If not, the page shows its diagnosis."""
        return self.result.diagnosis.kind is Kind.OK

    @property
    def has_player(self) -> bool:
        """Whether the page contains a player with a run."""
        pictures = [*self.pictures, *(picture for group in self.groups for picture in group.pictures)]
        return self.graded and any(picture.run is not None for picture in pictures)

    @property
    def percent(self) -> int:
        """The score as a percentage, rounded down."""
        return int(self.result.percent + 1e-9)


def page_view(result: Result, folder: Path | None, contract: Mapping[str, Requirement] = {}) -> PageView:
    """Return the content of the page of a result.

    Args:
        result: the result to show.
        folder: the folder with its artifacts, or None for a page without pictures.
        contract: the assignment's requirements, by their ids.
    """
    check_ids = {check.id for check in result.checks}
    pictures: dict[str, list[Picture]] = {}
    for artifact in result.artifacts:
        picture = None if folder is None else read_picture(artifact, folder)
        if picture is not None:
            pictures.setdefault(artifact.check if artifact.check in check_ids else "", []).append(picture)
    all_causes = causes(result.checks, result.diagnosis.sentence)

    def view(check: CheckResult, cause: Cause | None = None, quoted: tuple[str, ...] = ()) -> CheckView:
        # A program that does not run does not break a particular requirement.
        is_specific = check.outcome is Outcome.FAILED and check.message != result.diagnosis.sentence
        covered = check.holds if is_specific else ()
        sentences = dict.fromkeys(contract[name].text for name in covered if name in contract)
        unquoted = tuple(sentence for sentence in sentences if sentence not in quoted)
        check_view = CheckView(check, unquoted, tuple(pictures.get(check.id, ())))
        if cause is None:
            return check_view
        also_failed: list[CheckView] = []
        for failed_check in cause.failed:
            earlier = (sentence for other in also_failed for sentence in other.contract)
            also_failed.append(view(failed_check, quoted=(*unquoted, *earlier)))
        return replace(check_view, also_failed=tuple(also_failed), not_checked=cause.not_checked, unnamed=cause.unnamed)

    groups = []
    for name in dict.fromkeys(check.group for check in result.checks):
        views = tuple(view(cause.check, cause) for cause in all_causes if cause.check.group == name)
        members = ((cause, tuple(check for check in cause.checks if check.group == name)) for cause in all_causes)
        elsewhere = tuple(
            DependentChecks(cause.check, checks) for cause, checks in members if checks and cause.check.group != name
        )
        groups.append(GroupView(name, result.group(name), views, elsewhere))
    return PageView(result, tuple(groups), tuple(pictures.get("", ())), costliest_failure(all_causes))
