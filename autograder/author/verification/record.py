"""Records what the named mutants fail, and their diagnoses, from the results of their gradings."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from autograder.author.verification import snapshot
from autograder.author.verification.claims import CaseKind, Claim, lost_checks, verify_mutant
from autograder.author.verification.mutants import mutants
from autograder.author.verification.snapshot import Record
from autograder.result.model import Status


def record_failures(assignment: str, claims: Iterable[Claim]) -> str:
    """Record what the graded mutants of an assignment fail, and their diagnoses; return what changed, in words.

    A mutant that was not graded keeps its record, and one that `mutants.yaml` no longer has loses it. A mutant that
    passes the check for which it was written proves nothing, so its result is not recorded.
    """
    written_for = {mutant.id: mutant.check for mutant in mutants(assignment)}
    seen = {
        claim.name: Record(lost_checks(claim.result), claim.result.diagnosis.kind)
        for claim in claims
        if claim.assignment == assignment and _is_recordable(claim)
    }
    useless = sorted(name for name, record in seen.items() if written_for[name] not in record.fails)
    before = snapshot.recorded(assignment)
    after = before | {name: record for name, record in seen.items() if name not in useless}
    after = {name: after[name] for name in written_for if name in after}
    snapshot.write(assignment, after)
    changed = sum(before.get(name) != after.get(name) for name in before | after)
    text = f"{assignment}: {len(seen)} mutants graded, {changed} records changed"
    return text + (f"; not recorded, because they pass their own check: {', '.join(useless)}" if useless else "")


def compared_again(claims: Iterable[Claim]) -> tuple[Claim, ...]:
    """Return the claims with the results of named mutants compared with what is recorded now."""
    claims = tuple(claims)
    known = {
        (assignment, mutant.id): mutant
        for assignment in {claim.assignment for claim in claims}
        for mutant in mutants(assignment)
    }
    return tuple(
        replace(claim, mismatch=verify_mutant(known[claim.assignment, claim.name], claim.result))
        if _is_recordable(claim)
        else claim
        for claim in claims
    )


def _is_recordable(claim: Claim) -> bool:
    """Return whether a claim is of a named mutant that every check judged."""
    graded = claim.result.status is Status.GRADED and not claim.result.unjudged
    return claim.kind is CaseKind.MUTANT and graded
