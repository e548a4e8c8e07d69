"""Groups failures by their causes. A student fixes the cause first, and runs the checks again.

A check names other checks whose failure probably causes its own (`CheckResult.after`). Checks with the same message
also have the same cause, such as a failed build or a crashed program.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from autograder.result.model import CheckResult
from autograder.suite import Outcome

FAILED_AS_WELL = "These also failed. Fix the one above first, then run again:"
MAX_NAMED = 3  # the most titles in the line about checks that could not run


@dataclass(frozen=True)
class Cause:
    """A check, and the checks that did not pass because of it.

    Attributes:
        check: the check that failed first, or a check that passed, which has no consequences.
        failed: the checks that also failed.
        unchecked: the checks that could not be checked.
    """

    check: CheckResult
    failed: tuple[CheckResult, ...] = ()
    unchecked: tuple[CheckResult, ...] = ()

    @property
    def checks(self) -> tuple[CheckResult, ...]:
        """The check and its consequences."""
        return self.check, *self.failed, *self.unchecked

    @property
    def lost(self) -> float:
        """The points lost by this cause, rounded so that sums of the same points are equal."""
        return round(math.fsum(check.max_points - check.points for check in self.checks), 4)

    @property
    def not_checked(self) -> str:
        """The line about checks that could not run, or an empty string. It names at most `MAX_NAMED` checks."""
        if not self.unchecked:
            return ""
        titles = " ".join(check.title for check in self.unchecked)
        return f"Not checked: {len(self.unchecked)} more checks." if self.unnamed else f"Not checked: {titles}"

    @property
    def unnamed(self) -> tuple[str, ...]:
        """The titles of the checks that could not run, if there are too many for the line."""
        titles = tuple(check.title for check in self.unchecked)
        return titles if len(titles) > MAX_NAMED else ()


def causes(checks: Sequence[CheckResult], diagnosis: str = "") -> tuple[Cause, ...]:
    """Group the checks of a result by their causes, in the order of the causes. Each check is in one group.

    Args:
        checks: the results of checks.
        diagnosis: the sentence about the failure of the program, which may also be the message of a check.
    """
    indices = {check.id: index for index, check in reversed(list(enumerate(checks)))}
    cause_of = [_cause_of(index, checks, indices) for index in range(len(checks))]
    first_with_message: dict[str, int] = {}  # for each message, the index of the first check with it
    for index in sorted(set(cause_of)):
        check = checks[index]
        is_shared = check.outcome is Outcome.NOT_CHECKED or (
            check.outcome is Outcome.FAILED and check.message == diagnosis
        )
        if is_shared and first_with_message.setdefault(check.message, index) != index:
            cause_of = [first_with_message[check.message] if other == index else other for other in cause_of]
    consequences_of: dict[int, list[CheckResult]] = {index: [] for index in sorted(set(cause_of))}
    for index, check in enumerate(checks):
        if cause_of[index] != index:
            consequences_of[cause_of[index]].append(check)
    return tuple(
        Cause(
            checks[index],
            tuple(check for check in consequences if check.outcome is Outcome.FAILED),
            tuple(check for check in consequences if check.outcome is Outcome.NOT_CHECKED),
        )
        for index, consequences in consequences_of.items()
    )


def costliest_failure(all_causes: Sequence[Cause]) -> CheckResult | None:
    """Return the failed check that costs the most points, including its consequences; None if no check failed."""
    failed = [cause for cause in all_causes if cause.check.outcome is Outcome.FAILED]
    return max(failed, key=lambda cause: cause.lost).check if failed else None


def _cause_of(index: int, checks: Sequence[CheckResult], indices: Mapping[str, int]) -> int:
    """Return the index of the check that caused a failure, or `index` if the check passed or failed by itself."""
    visited: set[int] = set()
    while checks[index].outcome is not Outcome.PASSED and index not in visited:
        visited.add(index)
        earlier = (indices[name] for name in checks[index].after if name in indices)
        index = next((other for other in earlier if checks[other].outcome is not Outcome.PASSED), index)
    return index
