"""Compares the result of a submission of the proof with the result that it must have.

Each `verify_` function gets the result of a submission that was graded. It returns the differences in words, and an
empty string if there are none.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import Enum
from functools import cache
from pathlib import Path

from autograder import layout
from autograder.author.verification.leaks import LOOT
from autograder.author.verification.mutants import Mutant
from autograder.diagnosis import Kind
from autograder.result.model import Result
from autograder.suite import Outcome, suites

RECORD = "`autograder verify --record`"


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
    """Return how a mutant's result differs from its recorded failures and its diagnosis.

    A mutant that passes the check for which it was written is wrong, whatever is recorded.

    Args:
        mutant: the mutant that was graded.
        result: its result.
        only: the ids of the checks that were run; every check if there are none. The diagnosis is compared only if
            every check was run, because any of them may have made it.
    """
    failed, recorded, asked = lost_checks(result), mutant.fails, only or {check.id for check in result.checks}
    wrong = []
    if mutant.check in asked - failed:
        wrong.append(f"passes {mutant.check}, for which it was written")
    if not recorded:
        wrong.append(f"has no recorded failures: {RECORD} writes them")
    else:
        failed, recorded = failed & asked, recorded & asked
        changes = [f"also fails {', '.join(sorted(failed - recorded))}"] if failed - recorded else []
        changes += [f"passes {', '.join(sorted(recorded - failed))}"] if recorded - failed else []
        wrong += [f"{'; '.join(changes)} (if this is right, {RECORD} records it)"] if changes else []
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
    because the payload disturbs nothing. The result has one of the diagnoses, or any if there are none. What a student
    reads first holds the text `says`, if every check was run.
    """

    id: str
    description: str
    write: Callable[[Path], None]
    loses: frozenset[str]
    diagnosis: frozenset[Kind] = frozenset()
    exactly: bool = False
    says: str = ""

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
        if not only and self.says not in (first := first_sentence(result)):
            wrong.append(f"is told: {first}")
        wrong += [f"shows {line}" for line in stolen(result)[:1]]
        return "; ".join(wrong)


def first_sentence(result: Result) -> str:
    """Return what a student reads first."""
    if result.diagnosis.kind is not Kind.OK:
        return result.diagnosis.sentence
    return next((check.message for check in result.checks if check.outcome is Outcome.FAILED), "")


def stolen(result: Result) -> list[str]:
    """Return what a result shows of hidden checks, and of what a payload says that it has stolen."""
    shown = "\n".join(_texts(result.to_json()))
    return sorted(line for line in {LOOT, *hidden_lines(result.assignment)} if line in shown)


def _texts(value: object) -> Iterator[str]:
    """Yield every text in JSON."""
    if isinstance(value, str):
        yield value
    for part in value.values() if isinstance(value, dict) else value if isinstance(value, list) else ():
        yield from _texts(part)


@cache
def hidden_lines(assignment: str) -> frozenset[str]:
    """Return lines that stand in an assignment's hidden suite only: whoever prints one of them has read it."""
    lines = {
        line.strip()
        for path in suites.hidden(assignment).files
        for line in path.read_text(encoding="utf-8").splitlines()
        if line.startswith(("def ", "    expect", "        expect")) and len(line.strip()) > 30
    }
    public = [path for name in ("support", "visible") for path in layout.CHECKS.glob(f"ch*/{name}/*.py")]
    known = "\n".join(path.read_text(encoding="utf-8") for path in (*public, *layout.SOLUTIONS.rglob("*.py")))
    return frozenset(line for line in lines if line not in known)
