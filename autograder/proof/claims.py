"""Compares the result of a submission of the proof with the result that it must have.

Each `verify_` function gets the result of a submission that was graded. It returns the differences in words, and an
empty string if there are none.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from autograder.checks import Outcome
from autograder.diagnosis import Kind
from autograder.proof.mutants import Mutant
from autograder.result import Result


class CaseKind(str, Enum):
    """The kinds of submissions of the proof."""

    REFERENCE = "reference"
    RELEASE = "release"
    VARIANT = "variant"
    MUTANT = "mutant"
    GENERATED = "generated"
    ATTACK = "attack"


@dataclass(frozen=True)
class Claim:
    """The result of a submission of the proof, and how it differs from the expected one, in words.

    `mismatch` is empty if the claim holds. `reason` says why a generated mutant may survive.
    """

    assignment: str
    kind: CaseKind
    name: str
    result: Result
    mismatch: str
    reason: str = ""

    @property
    def holds(self) -> bool:
        """Whether the result is the expected one."""
        return not self.mismatch


def verify_full_marks(result: Result) -> str:
    """Return why a right answer has not every point."""
    if result.diagnosis.kind is not Kind.OK:
        return result.diagnosis.sentence
    missing = lost_checks(result)
    return f"loses {', '.join(sorted(missing))}" if missing else ""


def verify_zero(result: Result) -> str:
    """Return why an untouched release does not have 0 points."""
    return "" if result.score == 0 else f"it scores {result.score:g}"


def verify_mutant(mutant: Mutant, result: Result, only: frozenset[str] = frozenset()) -> str:
    """Return how a mutant's result differs from the losses and the diagnosis that the mutant names.

    Args:
        mutant: the mutant that was graded.
        result: its result.
        only: the ids of the checks that were run; every check if there are none. The diagnosis is compared only if
            every check was run, because any of them may have made it.
    """
    missing, named = lost_checks(result), mutant.loses
    if only:
        missing, named = missing & only, named & only
    wrong = [f"also loses {', '.join(sorted(missing - named))}"] if missing - named else []
    wrong += [f"keeps {', '.join(sorted(named - missing))}"] if named - missing else []
    if not only and result.diagnosis.kind is not mutant.diagnosis:
        wrong.append(f"is diagnosed {result.diagnosis.kind.value} instead of {mutant.diagnosis.value}")
    return "; ".join(wrong)


def verify_killed(result: Result) -> str:
    """Return that a generated mutant survived, if it passed every check."""
    return "" if lost_checks(result) else "survives: no check sees the difference"


def lost_checks(result: Result) -> frozenset[str]:
    """Return the ids of the checks that did not pass."""
    return frozenset(check.id for check in result.checks if check.outcome is not Outcome.PASSED)
