"""What a proof comes to, in numbers."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from autograder.proof.claims import Claim, Kind, graded, lost

ENOUGH = 0.9  # of the generated mutants that no reason excuses


def summary(claims: Sequence[Claim], seconds: float) -> dict[str, object]:
    """Count what was proved.

    `reference`, `release` and `variants` are percentages, the worst of their kind; `mutants_missed` lost nothing that
    they name, `mutants_wrong_check` lost something else or are diagnosed otherwise; `generated` leaves out the
    survivors that have a reason.
    """
    mutants, generated = _of(claims, Kind.MUTANT), _counted(claims)
    missed = [claim for claim in mutants if not (graded(claim.result) and lost(claim.result))]
    attacks = _of(claims, Kind.ATTACK)
    return {
        "reference": min(_percents(claims, Kind.REFERENCE), default=None),
        "release": max(_percents(claims, Kind.RELEASE), default=None),
        "variants": _percents(claims, Kind.VARIANT),
        "mutants": len(mutants),
        "mutants_missed": len(missed),
        "mutants_wrong_check": sum(not claim.holds for claim in mutants if claim not in missed),
        "generated": len(generated),
        "generated_killed": sum(claim.holds for claim in generated),
        "attacks": len(attacks),
        "attacks_gained": sum(not claim.holds for claim in attacks),
        "seconds": round(seconds, 1),
    }


def holds(claims: Sequence[Claim]) -> bool:
    """Return whether the proof stands: every claim holds, and enough of the generated mutants are killed."""
    generated = _counted(claims)
    killed = sum(claim.holds for claim in generated)
    others = [claim for claim in claims if claim.kind is not Kind.GENERATED]
    return all(claim.holds for claim in others) and killed >= ENOUGH * len(generated)


def _of(claims: Iterable[Claim], kind: Kind) -> list[Claim]:
    return [claim for claim in claims if claim.kind is kind]


def _counted(claims: Iterable[Claim]) -> list[Claim]:
    """Return the generated mutants, without the survivors that a reason excuses."""
    return [claim for claim in _of(claims, Kind.GENERATED) if claim.holds or not claim.reason]


def _percents(claims: Iterable[Claim], kind: Kind) -> list[float]:
    return [claim.result.percent for claim in _of(claims, kind)]
