"""What grading must make of a submission of the proof, and the judgement whether it did."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from autograder.checks import Outcome
from autograder.diagnosis import Kind as Diagnosed
from autograder.proof.mutants import Mutant
from autograder.result import Result, Status


class Kind(str, Enum):
    """What a submission of the proof is."""

    REFERENCE = "reference"
    RELEASE = "release"
    VARIANT = "variant"
    MUTANT = "mutant"
    GENERATED = "generated"
    ATTACK = "attack"


@dataclass(frozen=True)
class Claim:
    """What was claimed of one submission, and what came of it.

    Attributes:
        assignment: whose suite graded it.
        kind: what it is.
        name: its name.
        result: what grading gave.
        wrong: what is not as claimed, in words; empty when the claim holds.
        reason: why a generated mutant that survives may do so; empty otherwise.
    """

    assignment: str
    kind: Kind
    name: str
    result: Result
    wrong: str
    reason: str = ""

    @property
    def holds(self) -> bool:
        """Whether the grader did what it must."""
        return not self.wrong


def full(result: Result) -> str:
    """Say what keeps a right answer from all points; an empty string if nothing does."""
    if not graded(result) or result.diagnosis.kind is not Diagnosed.OK:
        return result.diagnosis.sentence
    missing = lost(result)
    return f"loses {', '.join(sorted(missing))}" if missing else ""


def nothing(result: Result) -> str:
    """Say what an untouched release gains; an empty string if nothing."""
    return "" if graded(result) and result.score == 0 else f"it scores {result.score:g}"


def as_named(mutant: Mutant, result: Result, only: frozenset[str] = frozenset()) -> str:
    """Say where a mutant's result differs from what the mutant names; an empty string if nowhere.

    Where `only` some checks were run, these alone are looked at, and the diagnosis, which others may make, is not.
    """
    if not graded(result):
        return result.diagnosis.sentence
    missing, named = lost(result), mutant.loses
    if only:
        missing, named = missing & only, named & only
    wrong = [f"also loses {', '.join(sorted(missing - named))}"] if missing - named else []
    wrong += [f"keeps {', '.join(sorted(named - missing))}"] if named - missing else []
    if not only and result.diagnosis.kind is not mutant.diagnosis:
        wrong.append(f"is diagnosed {result.diagnosis.kind.value} instead of {mutant.diagnosis.value}")
    return "; ".join(wrong)


def killed(result: Result) -> str:
    """Say that a generated mutant survived; an empty string if it lost something."""
    if not graded(result):
        return result.diagnosis.sentence
    return "" if lost(result) else "survives: no check sees the difference"


def lost(result: Result) -> frozenset[str]:
    """Return the ids of the checks that did not pass."""
    return frozenset(check.id for check in result.checks if check.outcome is not Outcome.PASSED)


def graded(result: Result) -> bool:
    """Return whether the grader did its work."""
    return result.status is Status.GRADED
