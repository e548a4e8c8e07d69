"""Counts the verdicts of a verification."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from autograder.author.verification.verdicts import CaseKind, Verdict, failed_checks
from autograder.result.model import Status


def summary(verdicts: Sequence[Verdict], seconds: float) -> dict[str, object]:
    """Count the verdicts of each kind.

    `reference` (the lowest), `release` (the highest) and `variants` (all) are percentages. `mutants_missed` counts the
    mutants that failed no check. `mutants_wrong_check` counts those whose failed checks or diagnosis differ from the
    snapshot.
    """
    mutants = _of_kind(verdicts, CaseKind.MUTANT)
    missed_mutants = [
        verdict
        for verdict in mutants
        if verdict.result.status is not Status.GRADED or not failed_checks(verdict.result)
    ]
    attacks = _of_kind(verdicts, CaseKind.ATTACK)
    return {
        "reference": min(_percents(verdicts, CaseKind.REFERENCE), default=None),
        "release": max(_percents(verdicts, CaseKind.RELEASE), default=None),
        "variants": _percents(verdicts, CaseKind.VARIANT),
        "mutants": len(mutants),
        "mutants_missed": len(missed_mutants),
        "mutants_wrong_check": sum(not verdict.is_expected for verdict in mutants if verdict not in missed_mutants),
        "attacks": len(attacks),
        "attacks_gained": sum(not verdict.is_expected for verdict in attacks),
        "seconds": round(seconds, 1),
    }


def _of_kind(verdicts: Iterable[Verdict], kind: CaseKind) -> list[Verdict]:
    return [verdict for verdict in verdicts if verdict.kind is kind]


def _percents(verdicts: Iterable[Verdict], kind: CaseKind) -> list[float]:
    return [verdict.result.percent for verdict in _of_kind(verdicts, kind)]
