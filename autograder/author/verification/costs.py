"""What each named mutant costs, against the points of the check for which it was written.

A cause costs at most the points of the sentences that it breaks. A mutant that loses more than twice the points of its
own check needs a reason. Some reasons follow from its result: the program was not built or did not live, checks could
not be run, other checks hold the same sentence or are declared to come after the mutant's own, or several checks say
word for word the same, such as that nobody understands a message. For what is left, an entry of `mutants.yaml` may have
a `reason`. Whoever has none is listed.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from autograder.author.course.markdown_table import table
from autograder.author.verification.claims import CaseKind, Claim
from autograder.author.verification.mutants import Mutant, mutants
from autograder.diagnosis import Kind
from autograder.result.model import CheckResult, Result, Status
from autograder.suite import Outcome

MOST = 2.0  # times the points of its own check
NOT_CHECKED, SAME, AFTER, ALIKE = "not checked", "of the same sentence", "after it", "for one and the same reason"
HEAD = """## What each named mutant costs

The points of its own check, those that it loses, and the sentences whose checks failed.
"""


@dataclass(frozen=True)
class Cost:
    """What one mutant loses.

    Attributes:
        assignment: the chapter.
        mutant: its id.
        check: the check for which it was written.
        points: the points of that check.
        lost: all points that it loses.
        sentences: ids of the sentences of the contract that the failed checks hold.
        reason: why it loses more than `MOST` times `points`; empty if it does not, or if nothing says why.
    """

    assignment: str
    mutant: str
    check: str
    points: float
    lost: float
    sentences: tuple[str, ...]
    reason: str = ""

    @property
    def is_dear(self) -> bool:
        """Whether it loses so much that it needs a reason."""
        return self.lost > MOST * self.points


def costs(claims: Iterable[Claim]) -> tuple[Cost, ...]:
    """Return what the named mutants among the claims cost, the dearest first. Their whole suites have to be run."""
    graded = [each for each in claims if each.kind is CaseKind.MUTANT and each.result.status is Status.GRADED]
    known = {(name, each.id): each for name in {claim.assignment for claim in graded} for each in mutants(name)}
    found = [_cost(known[claim.assignment, claim.name], claim.result) for claim in graded]
    return tuple(sorted(found, key=lambda cost: cost.lost / cost.points, reverse=True))


def unexplained(found: Sequence[Cost]) -> list[str]:
    """Return a sentence for each mutant that loses too much without a reason."""
    return [
        f"{cost.assignment} mutant {cost.mutant}: it loses {cost.lost:g} points, {cost.check} has {cost.points:g}, "
        "and nothing says why"
        for cost in found
        if cost.is_dear and not cost.reason
    ]


def counts(found: Sequence[Cost]) -> dict[str, object]:
    """Return how many mutants lose too much, and how many of them without a reason."""
    return {"mutants_dear": sum(cost.is_dear for cost in found), "mutants_dear_unexplained": len(unexplained(found))}


def report(found: Sequence[Cost]) -> str:
    """Return the table mutant x points x sentences, in Markdown."""
    head = ("chapter", "mutant", "its check", "points", "lost", "sentences broken", "reason")
    lines = table(head, (tuple(_cells(cost)) for cost in found))
    return "\n".join([HEAD, *lines]) if found else ""


def _cells(cost: Cost) -> Iterator[str]:
    yield from (cost.assignment[:2], cost.mutant, cost.check, f"{cost.points:g}", f"{cost.lost:g}")
    yield ", ".join(cost.sentences)
    yield cost.reason or ("**no reason**" if cost.is_dear else "")


def _cost(mutant: Mutant, result: Result) -> Cost:
    lost = [check for check in result.checks if check.outcome is not Outcome.PASSED]
    own = next(check for check in result.checks if check.id == mutant.check)
    broken = {sentence: None for check in lost if check.outcome is Outcome.FAILED for sentence in check.holds}
    cost = Cost(result.assignment, mutant.id, own.id, own.max_points, _points(lost), tuple(broken))
    return replace(cost, reason=_reason(mutant, result, own, lost)) if cost.is_dear else cost


def _reason(mutant: Mutant, result: Result, own: CheckResult, lost: Sequence[CheckResult]) -> str:
    if mutant.reason:
        return mutant.reason
    if result.diagnosis.kind is not Kind.OK:
        return str(result.diagnosis.kind.value).replace("_", " ")
    kinds: dict[str, list[CheckResult]] = {}
    for check in lost:
        kinds.setdefault(_kind(check, own, lost), []).append(check)
    if _points(kinds.pop("", ())) > MOST * own.max_points:
        return ""
    return "; ".join(f"{_points(checks):g} {kind}" for kind, checks in kinds.items())


def _kind(check: CheckResult, own: CheckResult, lost: Sequence[CheckResult]) -> str:
    """Return why a check was lost with the mutant's own one; an empty text for that one, and where nothing says why."""
    if check.id == own.id:
        return ""
    if check.outcome is Outcome.NOT_CHECKED:
        return NOT_CHECKED
    if set(check.holds) & set(own.holds):
        return SAME
    before = {each.id: each.after for each in lost}
    reached, pending = set[str](), [check.id]
    while pending:
        if (name := pending.pop()) in before and name not in reached:
            reached.add(name)
            pending += before[name]
    if own.id in reached:
        return AFTER
    return ALIKE if sum(each.message == check.message for each in lost) > 1 else ""


def _points(checks: Iterable[CheckResult]) -> float:
    return round(math.fsum(check.max_points - check.points for check in checks), 4)
