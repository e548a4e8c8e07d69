"""The page `checks.md` for instructors: the requirements, the hidden checks, and the mutants that fail them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from autograder.author.course.markdown_table import table
from autograder.author.verification.mutants import Mutant, mutants
from autograder.suite import Check, suites
from autograder.suite.contract import Requirement, contract

HEAD = """# The hidden checks and their mutants

For instructors: students do not get this page. Each check is listed with the sentence that the student reads, and with
the mutants that fail it directly. A mutant is a version of the reference with one small, realistic error, defined in
`mutants.yaml` beside the suite. `autograder verify` grades all of them. `autograder course tables` writes this page.

The requirements of a chapter are quoted from the notebook. Each is listed with the hidden checks that cover it and the
mutants that break it. If no check covers a requirement, the page gives the reason.
"""
CHECK_HEADINGS = ("check", "points", "the student reads", "fails in a version that")
REQUIREMENT_HEADINGS = ("id", "the notebook says", "covered by", "broken by")


def checks_page() -> str:
    """Return the page in Markdown."""
    return HEAD + "".join("\n".join(["", f"## {name}", "", *_chapter(name)]) for name in suites.graded_assignments())


def _chapter(name: str) -> list[str]:
    checks, named_mutants = suites.hidden(name).checks, mutants(name)
    check_rows = _check_rows(checks, named_mutants)
    requirements = contract(name).values()
    requirement_rows = [_requirement_row(requirement, checks, named_mutants) for requirement in requirements]
    heading = f"### The requirements of {name}\n"
    return [*table(CHECK_HEADINGS, check_rows), heading, *table(REQUIREMENT_HEADINGS, requirement_rows)]


def _requirement_row(
    requirement: Requirement, checks: Sequence[Check], named_mutants: Sequence[Mutant]
) -> tuple[str, ...]:
    name = f"`{requirement.id}`"
    if requirement.unchecked:
        return name, requirement.text, f"no check: {requirement.unchecked}", ""
    covering_checks = [check for check in checks if requirement.id in check.covers]
    breaking_mutants = dict.fromkeys(m.id for check in covering_checks for m in named_mutants if _fails(m, check))
    covering_names = ", ".join(f"`{check.id}`" for check in covering_checks)
    return name, requirement.text, covering_names, ", ".join(breaking_mutants)


def _check_rows(checks: Sequence[Check], named_mutants: Sequence[Mutant]) -> Iterator[tuple[str, ...]]:
    for check in checks:
        errors = [m.title for m in named_mutants if _fails(m, check)]
        yield f"`{check.id}`", f"{check.points:g}", check.title, "; ".join(errors)


def _fails(mutant: Mutant, check: Check) -> bool:
    """Return whether a mutant fails a check directly, without failing any of its dependencies."""
    return check.id in mutant.fails and not mutant.fails & set(check.dependencies)
