"""Compares the result of a submission of the proof with the result that it must have.

Each `verify_` function gets the result of a submission that was graded. It returns the differences in words, and an
empty string if there are none.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

from autograder.checks import Outcome, suites
from autograder.diagnosis import Kind
from autograder.proof.mutants import Mutant
from autograder.result import Result


class CaseKind(str, Enum):
    """The kinds of submissions of the proof."""

    REFERENCE = "reference"
    RELEASE = "release"
    VARIANT = "variant"
    MUTANT = "mutant"
    ATTACK = "attack"


@dataclass(frozen=True)
class Claim:
    """The result of a submission of the proof, and how it differs from the expected one, in words.

    `mismatch` is empty if the claim holds.
    """

    assignment: str
    kind: CaseKind
    name: str
    result: Result
    mismatch: str

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


def lost_checks(result: Result) -> frozenset[str]:
    """Return the ids of the checks that did not pass."""
    return frozenset(check.id for check in result.checks if check.outcome is not Outcome.PASSED)


@dataclass(frozen=True)
class Attack:
    """A malicious submission: the attacks that it combines, in words, and a function that writes it to a folder.

    `loses` holds the checks that it must lose, with or without the payload, and no others if it loses them `exactly`,
    because the payload disturbs nothing. The result has one of the diagnoses, or any if there are none.
    """

    id: str
    description: str
    write: Callable[[Path], None]
    loses: frozenset[str]
    diagnosis: frozenset[Kind] = frozenset()
    exactly: bool = False

    def verify(self, result: Result, only: frozenset[str] = frozenset()) -> str:
        """Return what the attack gained or disturbed, and an empty string if nothing.

        Args:
            result: result of the attack.
            only: ids of the checks that were run; every check if there are none.
        """
        suite = suites.hidden(result.assignment)
        run = only or frozenset(check.id for check in suite.checks)
        missing, loses = lost_checks(result) & run, self.loses & run
        wrong = [f"gains {', '.join(sorted(loses - missing))}"] if loses - missing else []
        if self.exactly and missing != loses:
            wrong.append(f"disturbs {', '.join(sorted(missing - loses))}")
        if result.max_score != suite.max_score:
            wrong.append(f"changes the maximum to {result.max_score:g}")
        if self.diagnosis and result.diagnosis.kind not in self.diagnosis:
            wrong.append(f"is diagnosed {result.diagnosis.kind.value}")
        return "; ".join(wrong)
