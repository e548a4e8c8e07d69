"""The points that each named mutant costs, compared with the points of the check for which it was written.

An error should cost at most the points of the requirements that it breaks. A mutant that loses more than twice the
points of its own check needs a reason. Some reasons follow from its result: the program did not build or run, checks
could not be run, other checks cover the same requirement or are declared `after` the mutant's own, or several checks
report the same message. Otherwise the entry in `mutants.yaml` may give a `reason`. Mutants without a reason are listed.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from autograder.author.course.markdown_table import table
from autograder.author.verification.mutants import Mutant, mutants
from autograder.author.verification.verdicts import CaseKind, Verdict
from autograder.diagnosis import Kind
from autograder.result.model import CheckResult, Result, Status
from autograder.suite import Outcome

MAX_RATIO = 2.0  # if a mutant loses more than this multiple of the points of its own check, it needs a reason
NOT_CHECKED, SAME_REQUIREMENT, AFTER, SAME_MESSAGE = (
    "not checked",
    "of the same requirement",
    "after it",
    "for the same reason",
)
HEAD = """## The cost of each named mutant

The points of its own check, the points that it loses, and the requirements whose checks failed.
"""


@dataclass(frozen=True)
class Cost:
    """The points that one mutant loses.

    Attributes:
        assignment: the chapter.
        mutant: its id.
        check: the check for which it was written.
        points: the points of that check.
        lost: all points that it loses.
        requirements: ids of the requirements that the failed checks cover.
        reason: why it loses more than `MAX_RATIO` times `points`; empty if it does not, or if there is no reason.
    """

    assignment: str
    mutant: str
    check: str
    points: float
    lost: float
    requirements: tuple[str, ...]
    reason: str = ""

    @property
    def is_expensive(self) -> bool:
        """Whether it loses so many points that it needs a reason."""
        return self.lost > MAX_RATIO * self.points


def costs(verdicts: Iterable[Verdict]) -> tuple[Cost, ...]:
    """Return the costs of the named mutants, most expensive first. Their whole suites must have been run."""
    graded_verdicts = [
        verdict for verdict in verdicts if verdict.kind is CaseKind.MUTANT and verdict.result.status is Status.GRADED
    ]
    by_id = {
        (name, mutant.id): mutant
        for name in {verdict.assignment for verdict in graded_verdicts}
        for mutant in mutants(name)
    }
    unsorted_costs = [_cost(by_id[verdict.assignment, verdict.name], verdict.result) for verdict in graded_verdicts]
    return tuple(sorted(unsorted_costs, key=lambda cost: cost.lost / cost.points, reverse=True))


def unexplained(costs: Sequence[Cost]) -> list[str]:
    """Return a sentence for each mutant that loses too many points without a reason."""
    return [
        f"{cost.assignment} mutant {cost.mutant}: it loses {cost.lost:g} points, {cost.check} is worth "
        f"{cost.points:g}, and no reason is given: write a `reason` in mutants.yaml, or declare a check `after` "
        f"{cost.check}"
        for cost in costs
        if cost.is_expensive and not cost.reason
    ]


def counts(costs: Sequence[Cost]) -> dict[str, object]:
    """Return how many mutants lose so many points that they need a reason, and how many of these have none."""
    expensive = sum(cost.is_expensive for cost in costs)
    return {"mutants_expensive": expensive, "mutants_expensive_unexplained": len(unexplained(costs))}


def report(costs: Sequence[Cost]) -> str:
    """Return a Markdown table of the mutants, their points and the requirements that they break."""
    headings = ("chapter", "mutant", "its check", "points", "lost", "requirements broken", "reason")
    lines = table(headings, (tuple(_cells(cost)) for cost in costs))
    return "\n".join([HEAD, *lines]) if costs else ""


def _cells(cost: Cost) -> Iterator[str]:
    yield from (cost.assignment[:2], cost.mutant, cost.check, f"{cost.points:g}", f"{cost.lost:g}")
    yield ", ".join(cost.requirements)
    yield cost.reason or ("**no reason**" if cost.is_expensive else "")


def _cost(mutant: Mutant, result: Result) -> Cost:
    not_passed = [check for check in result.checks if check.outcome is not Outcome.PASSED]
    own_check = next(check for check in result.checks if check.id == mutant.check)
    requirements_findings = dict.fromkeys(
        name for check in not_passed if check.outcome is Outcome.FAILED for name in check.holds
    )
    lost = _points(not_passed)
    cost = Cost(result.assignment, mutant.id, own_check.id, own_check.max_points, lost, tuple(requirements_findings))
    return replace(cost, reason=_reason(mutant, result, own_check, not_passed)) if cost.is_expensive else cost


def _reason(mutant: Mutant, result: Result, own_check: CheckResult, not_passed: Sequence[CheckResult]) -> str:
    if mutant.reason:
        return mutant.reason
    if result.diagnosis.kind is not Kind.OK:
        return str(result.diagnosis.kind.value).replace("_", " ")
    by_explanation: dict[str, list[CheckResult]] = {}
    for check in not_passed:
        by_explanation.setdefault(_explanation(check, own_check, not_passed), []).append(check)
    if _points(by_explanation.pop("", ())) > MAX_RATIO * own_check.max_points:
        return ""
    return "; ".join(f"{_points(checks):g} {explanation}" for explanation, checks in by_explanation.items())


def _explanation(check: CheckResult, own_check: CheckResult, not_passed: Sequence[CheckResult]) -> str:
    """Return why a check failed together with the mutant's own check, or an empty string if nothing explains it."""
    if check.id == own_check.id:
        return ""
    if check.outcome is Outcome.NOT_CHECKED:
        return NOT_CHECKED
    if set(check.holds) & set(own_check.holds):
        return SAME_REQUIREMENT
    predecessors = {other.id: other.after for other in not_passed}
    reached_checks, pending_checks = set[str](), [check.id]
    while pending_checks:
        if (name := pending_checks.pop()) in predecessors and name not in reached_checks:
            reached_checks.add(name)
            pending_checks += predecessors[name]
    if own_check.id in reached_checks:
        return AFTER
    return SAME_MESSAGE if sum(other.message == check.message for other in not_passed) > 1 else ""


def _points(checks: Iterable[CheckResult]) -> float:
    return round(math.fsum(check.max_points - check.points for check in checks), 4)
