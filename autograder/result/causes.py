"""Groups failures by their causes: a student fixes the cause first, and runs the checks again.

A check names other checks whose failure probably causes its own (`CheckResult.after`). Checks with the same reason also
have one cause: a build that failed, or a program that crashed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from autograder.result.model import CheckResult
from autograder.suite import Outcome

FAILED_AS_WELL = "These failed as well; mend the first and run again:"
MAX_NAMED = 3  # titles in the line about unchecked behaviour


@dataclass(frozen=True)
class Cause:
    """A check, and those that did not pass because it did not.

    Attributes:
        check: the check that failed first. A check that passed is no cause.
        failed: the checks that failed as well.
        unchecked: the checks that could not be checked.
    """

    check: CheckResult
    failed: tuple[CheckResult, ...] = ()
    unchecked: tuple[CheckResult, ...] = ()

    @property
    def checks(self) -> tuple[CheckResult, ...]:
        """All of its checks."""
        return self.check, *self.failed, *self.unchecked

    @property
    def lost(self) -> float:
        """The points that it costs, rounded so that sums of the same points are equal."""
        return round(math.fsum(check.max_points - check.points for check in self.checks), 4)

    @property
    def not_checked(self) -> str:
        """The line about checks that could not run, or an empty string. It names a few and counts many."""
        if not self.unchecked:
            return ""
        few = " ".join(check.title for check in self.unchecked)
        return f"Not checked: {len(self.unchecked)} more checks." if self.unnamed else f"Not checked: {few}"

    @property
    def unnamed(self) -> tuple[str, ...]:
        """The titles of checks that could not run, if they are too many for the line."""
        titles = tuple(check.title for check in self.unchecked)
        return titles if len(titles) > MAX_NAMED else ()


def causes(checks: Sequence[CheckResult], diagnosis: str = "") -> tuple[Cause, ...]:
    """Group the checks of a result by their causes, in the order of the causes; each check is in one of them.

    Args:
        checks: the results of checks.
        diagnosis: the sentence about the failure of the program, which a check may give as its reason.
    """
    places = {check.id: place for place, check in reversed(list(enumerate(checks)))}
    first = [_first(place, checks, places) for place in range(len(checks))]
    reasons: dict[str, int] = {}  # the places of the checks that gave a reason first
    for place in sorted(set(first)):
        check = checks[place]
        shared = check.outcome is Outcome.NOT_CHECKED or (
            check.outcome is Outcome.FAILED and check.message == diagnosis
        )
        if shared and reasons.setdefault(check.message, place) != place:
            first = [reasons[check.message] if other == place else other for other in first]
    members: dict[int, list[CheckResult]] = {place: [] for place in sorted(set(first))}
    for place, check in enumerate(checks):
        if first[place] != place:
            members[first[place]].append(check)
    return tuple(
        Cause(
            checks[place],
            tuple(check for check in came if check.outcome is Outcome.FAILED),
            tuple(check for check in came if check.outcome is Outcome.NOT_CHECKED),
        )
        for place, came in members.items()
    )


def dearest(all_causes: Sequence[Cause]) -> CheckResult | None:
    """Return the check that failed and costs most points, with all that came with it; None if none failed."""
    failed = [cause for cause in all_causes if cause.check.outcome is Outcome.FAILED]
    return max(failed, key=lambda cause: cause.lost).check if failed else None


def _first(place: int, checks: Sequence[CheckResult], places: Mapping[str, int]) -> int:
    """Return the place of the check from which a failure came: the check's own if it passed, or came from none."""
    seen: set[int] = set()
    while checks[place].outcome is not Outcome.PASSED and place not in seen:
        seen.add(place)
        earlier = (places[name] for name in checks[place].after if name in places)
        place = next((other for other in earlier if checks[other].outcome is not Outcome.PASSED), place)
    return place
