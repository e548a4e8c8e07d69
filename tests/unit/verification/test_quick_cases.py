"""`autograder verify --quick` grades a mutant for each check, whether or not the mutants have records."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from autograder.author.verification import snapshot
from autograder.author.verification.cases import cases, one_mutant_per_check
from autograder.author.verification.mutants import mutants
from autograder.author.verification.snapshot import Record
from autograder.author.verification.verdicts import CaseKind

ASSIGNMENT = "02_nodes"
CHECKS = frozenset(mutant.check for mutant in mutants(ASSIGNMENT))


def keep_records(monkeypatch: pytest.MonkeyPatch, records: Mapping[str, Record]) -> None:
    monkeypatch.setattr(snapshot, "recorded", lambda assignment: dict(records))


def test_without_a_snapshot_a_mutant_that_was_written_for_each_check_is_graded(monkeypatch: pytest.MonkeyPatch) -> None:
    keep_records(monkeypatch, {})
    chosen = one_mutant_per_check(ASSIGNMENT)
    assert sorted(mutant.check for mutant, _ in chosen) == sorted(CHECKS)
    assert all(set(only) >= {mutant.check} for mutant, only in chosen)
    assert sum(case.kind is CaseKind.MUTANT for case in cases(ASSIGNMENT, quick=True)) == len(CHECKS)


def test_a_mutant_without_a_record_represents_only_checks_that_no_recorded_mutant_fails(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    records = {mutant.id: Record(mutant.fails, mutant.diagnosis) for mutant in mutants(ASSIGNMENT)}
    complete = {mutant.id for mutant, _ in one_mutant_per_check(ASSIGNMENT)}
    unused = next(name for name in records if name not in complete)
    keep_records(monkeypatch, {name: record for name, record in records.items() if name != unused})
    assert {mutant.id for mutant, _ in one_mutant_per_check(ASSIGNMENT)} == complete

    check = next(mutant.check for mutant in mutants(ASSIGNMENT) if mutant.id == unused)
    keep_records(monkeypatch, {name: record for name, record in records.items() if check not in record.fails})
    represents = [(mutant.check, mutant.fails) for mutant, only in one_mutant_per_check(ASSIGNMENT) if check in only]
    assert (check, frozenset()) in represents
