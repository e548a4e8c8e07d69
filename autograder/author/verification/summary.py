"""Counts the claims of a proof."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from autograder.author.verification.claims import CaseKind, Claim, lost_checks
from autograder.result.model import Status


def summary(claims: Sequence[Claim], seconds: float) -> dict[str, object]:
    """Count the claims of each kind.

    `reference` (the least), `release` (the highest) and `variants` (all) are percentages. `mutants_missed` counts the
    mutants that lost no check. `mutants_wrong_check` counts those that lost other checks than they name, or have
    another diagnosis.
    """
    mutants = _of(claims, CaseKind.MUTANT)
    missed = [claim for claim in mutants if not (claim.result.status is Status.GRADED and lost_checks(claim.result))]
    attacks = _of(claims, CaseKind.ATTACK)
    return {
        "reference": min(_percents(claims, CaseKind.REFERENCE), default=None),
        "release": max(_percents(claims, CaseKind.RELEASE), default=None),
        "variants": _percents(claims, CaseKind.VARIANT),
        "mutants": len(mutants),
        "mutants_missed": len(missed),
        "mutants_wrong_check": sum(not claim.holds for claim in mutants if claim not in missed),
        "attacks": len(attacks),
        "attacks_gained": sum(not claim.holds for claim in attacks),
        "seconds": round(seconds, 1),
    }


def _of(claims: Iterable[Claim], kind: CaseKind) -> list[Claim]:
    return [claim for claim in claims if claim.kind is kind]


def _percents(claims: Iterable[Claim], kind: CaseKind) -> list[float]:
    return [claim.result.percent for claim in _of(claims, kind)]
