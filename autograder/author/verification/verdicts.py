"""Compares the result of a test case with the expected result.

Each `verify_` function takes the result of a graded submission. It describes the differences, or returns an empty
string if there are none.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import Enum
from functools import cache
from pathlib import Path

from autograder import course_paths
from autograder.author.verification.leaks import STOLEN
from autograder.author.verification.mutants import Mutant
from autograder.diagnosis import Kind
from autograder.result.model import Result
from autograder.suite import Outcome, suites

RECORD = "`autograder verify --record`"
# With one of these diagnoses, a release is broken. It may fail to build only if its suite permits this.
BROKEN = {
    *(Kind.UNSAFE_ARCHIVE, Kind.UNREADABLE, Kind.UNCLEAR, Kind.NOTHING_SUBMITTED, Kind.NOTEBOOK_FAILED),
    Kind.RESERVED_NAME,
}
NOT_BUILT = {Kind.SYNTAX_ERROR, Kind.BUILD_FAILED, Kind.MISSING_PACKAGE, Kind.HALF_WRITTEN_PACKAGE}


class CaseKind(str, Enum):
    """The kinds of test cases."""

    REFERENCE = "reference"
    RELEASE = "release"
    VARIANT = "variant"
    MUTANT = "mutant"
    ATTACK = "attack"


@dataclass(frozen=True)
class Verdict:
    """The result of a test case, and a description of how it differs from the expected result.

    `mismatch` is empty if the result is the expected one. `only` names the checks that were run; empty means every
    check. If only some checks were run, the points are not a mark.
    """

    assignment: str
    kind: CaseKind
    name: str
    result: Result
    mismatch: str
    only: tuple[str, ...] = ()

    @property
    def is_expected(self) -> bool:
        """Whether the result is the expected one."""
        return not self.mismatch


def verify_full_marks(result: Result) -> str:
    """Describe why a correct answer does not have full marks, or return an empty string."""
    if result.diagnosis.kind is not Kind.OK:
        return result.diagnosis.sentence
    failed_ids = failed_checks(result)
    if not failed_ids:
        return ""
    return f"fails {', '.join(sorted(failed_ids))}: {first_sentence(result)}"


def verify_zero(result: Result) -> str:
    """Describe why an untouched student release scores points or is broken, or return an empty string."""
    if result.score:
        return f"it scores {result.score:g}"
    diagnoses_findings = BROKEN if suites.hidden(result.assignment).build_may_fail else BROKEN | NOT_BUILT
    return f"students get it broken: {result.diagnosis.sentence}" if result.diagnosis.kind in diagnoses_findings else ""


def verify_mutant(mutant: Mutant, result: Result, only: frozenset[str] = frozenset()) -> str:
    """Describe how a mutant's result differs from its recorded failures and diagnosis.

    A mutant that passes the check for which it was written is a mismatch, regardless of its record.

    Args:
        mutant: the mutant that was graded.
        result: its result.
        only: ids of the checks that were run; empty means every check. The diagnosis is compared only if every check
            was run, because any of them may have caused it.
    """
    failed_ids, recorded_ids, graded_ids = (
        failed_checks(result),
        mutant.fails,
        only or {check.id for check in result.checks},
    )
    differences = []
    if mutant.check in graded_ids - failed_ids:
        differences.append(f"passes {mutant.check}, for which it was written")
    if not recorded_ids:
        command = f"autograder verify --assignment {result.assignment} --only {mutant.id} --record"
        differences.append(f"has no recorded failures: `{command}` writes them")
    else:
        failed_ids, recorded_ids = failed_ids & graded_ids, recorded_ids & graded_ids
        changes = [f"also fails {', '.join(sorted(failed_ids - recorded_ids))}"] if failed_ids - recorded_ids else []
        changes += [f"passes {', '.join(sorted(recorded_ids - failed_ids))}"] if recorded_ids - failed_ids else []
        if changes:
            differences.append(f"{'; '.join(changes)} (if this is correct, {RECORD} updates the snapshot)")
    if not only and result.diagnosis.kind is not mutant.diagnosis:
        differences.append(f"is diagnosed {result.diagnosis.kind.value} instead of {mutant.diagnosis.value}")
    return "; ".join(differences)


def failed_checks(result: Result) -> frozenset[str]:
    """Return the ids of the checks that did not pass."""
    return frozenset(check.id for check in result.checks if check.outcome is not Outcome.PASSED)


@dataclass(frozen=True)
class Attack:
    """A malicious submission: a description of the attacks that it combines, and a function that writes it to a folder.

    `fails` names the checks that it must fail, with or without the payload. If `exactly` is set, the payload must not
    make any other check fail. The result must have one of the diagnoses in `diagnosis`; an empty set means any. If
    every check was run, the first sentence that a student reads must contain the text `says`.
    """

    id: str
    description: str
    write: Callable[[Path], None]
    fails: frozenset[str]
    diagnosis: frozenset[Kind] = frozenset()
    exactly: bool = False
    says: str = ""

    def verify(self, result: Result, only: frozenset[str] = frozenset()) -> str:
        """Describe what the attack gains or disturbs, or return an empty string.

        Args:
            result: the result of the attack.
            only: ids of the checks that were run; empty means every check.
        """
        suite = suites.hidden(result.assignment)
        graded_ids = only or frozenset(check.id for check in suite.checks)
        failed_ids, expected_ids = failed_checks(result) & graded_ids, self.fails & graded_ids
        problems = [f"gains {', '.join(sorted(expected_ids - failed_ids))}"] if expected_ids - failed_ids else []
        if self.exactly and failed_ids != expected_ids:
            problems.append(f"disturbs {', '.join(sorted(failed_ids - expected_ids))}")
        if result.max_score != suite.max_score:
            problems.append(f"changes the maximum to {result.max_score:g}")
        if self.diagnosis and result.diagnosis.kind not in self.diagnosis:
            problems.append(f"is diagnosed {result.diagnosis.kind.value}")
        if not only and self.says not in (first := first_sentence(result)):
            problems.append(f"is told: {first}")
        problems += [f"shows {line}" for line in leaked_lines(result)[:1]]
        return "; ".join(problems)


def first_sentence(result: Result) -> str:
    """Return the first sentence that a student reads."""
    if result.diagnosis.kind is not Kind.OK:
        return result.diagnosis.sentence
    return next((check.message for check in result.checks if check.outcome is Outcome.FAILED), "")


def leaked_lines(result: Result) -> list[str]:
    """Return the hidden lines that appear in a result, and the marker of a theft if a payload printed it."""
    text = "\n".join(_strings_in(result.to_json()))
    return sorted(line for line in {STOLEN, *hidden_lines(result.assignment)} if line in text)


def _strings_in(value: object) -> Iterator[str]:
    """Yield every string in JSON data."""
    if isinstance(value, str):
        yield value
    for part in value.values() if isinstance(value, dict) else value if isinstance(value, list) else ():
        yield from _strings_in(part)


@cache
def hidden_lines(assignment: str) -> frozenset[str]:
    """Return the lines that occur only in an assignment's hidden suite. A program that prints one has read it."""
    lines = {
        line.strip()
        for path in suites.hidden(assignment).files
        for line in path.read_text(encoding="utf-8").splitlines()
        if line.startswith(("def ", "    expect", "        expect")) and len(line.strip()) > 30
    }
    public = [path for name in ("support", "visible") for path in course_paths.CHECKS.glob(f"ch*/{name}/*.py")]
    public_text = "\n".join(
        path.read_text(encoding="utf-8") for path in (*public, *course_paths.SOLUTIONS.rglob("*.py"))
    )
    return frozenset(line for line in lines if line not in public_text)
