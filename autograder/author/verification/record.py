"""Records the failed checks and the diagnosis of each graded mutant in the snapshot."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from autograder.author.verification import snapshot
from autograder.author.verification.mutants import mutants
from autograder.author.verification.snapshot import Record
from autograder.author.verification.verdicts import CaseKind, Verdict, failed_checks, verify_mutant
from autograder.result.model import Status


def record_failures(assignment: str, verdicts: Iterable[Verdict]) -> str:
    """Record the failures and diagnoses of the graded mutants of an assignment, and describe what changed.

    A mutant that was not graded keeps its record. Records of mutants that are no longer in `mutants.yaml` are removed.
    A mutant that passes the check for which it was written proves nothing, so its result is not recorded.
    """
    written_for = {mutant.id: mutant.check for mutant in mutants(assignment)}
    observed_records = {
        verdict.name: Record(failed_checks(verdict.result), verdict.result.diagnosis.kind)
        for verdict in verdicts
        if verdict.assignment == assignment and _is_recordable(verdict)
    }
    useless_mutants = sorted(name for name, record in observed_records.items() if written_for[name] not in record.fails)
    old_records = snapshot.recorded(assignment)
    merged_records = old_records | {
        name: record for name, record in observed_records.items() if name not in useless_mutants
    }
    new_records = {name: merged_records[name] for name in written_for if name in merged_records}
    snapshot.write(assignment, new_records)
    change_count = sum(old_records.get(name) != new_records.get(name) for name in old_records | new_records)
    text = f"{assignment}: {len(observed_records)} mutants graded, {change_count} records changed"
    return text + (
        f"; not recorded, because they pass their own check: {', '.join(useless_mutants)}" if useless_mutants else ""
    )


def compare_again(verdicts: Iterable[Verdict]) -> tuple[Verdict, ...]:
    """Compare the results of named mutants with the current snapshot, and return the updated verdicts."""
    verdicts = tuple(verdicts)
    by_id = {
        (assignment, mutant.id): mutant
        for assignment in {verdict.assignment for verdict in verdicts}
        for mutant in mutants(assignment)
    }
    return tuple(
        replace(verdict, mismatch=verify_mutant(by_id[verdict.assignment, verdict.name], verdict.result))
        if _is_recordable(verdict)
        else verdict
        for verdict in verdicts
    )


def _is_recordable(verdict: Verdict) -> bool:
    """Return whether a verdict belongs to a named mutant that was graded by every check."""
    is_graded = verdict.result.status is Status.GRADED and not verdict.result.unjudged
    return verdict.kind is CaseKind.MUTANT and is_graded
